// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The signs of encoders from moves of the grip by a hand that misses distance and direction.
#include <Eigen/Geometry>

#include "spidar/selftest/encoder_signs.h"
#include "tests/support/test.h"

namespace spidar::test::encoder_signs_test {
namespace {

/// The grip is moved by the wanted distance times 0.8 … 1.3, up to 10° beside the direction, and
/// turned until its points move by up to a tenth of the distance. `slack`: strings are only paid
/// out; otherwise something winds them up.
selftest::HandMoves moves_of(const Profile& real, bool slack, std::mt19937& random) {
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  const auto any_turn = [&](double most_rad) {
    const Eigen::Vector3d axis(between(-1, 1), between(-1, 1), between(-1, 1));
    return Eigen::AngleAxisd(between(0, most_rad), axis.normalized());
  };
  selftest::HandMoves moves;
  moves.distance_m = selftest::hand_move_m(real.geometry);
  double radius_m = 0;
  for (const Eigen::Vector3d& point_m : real.geometry.grip_m)
    radius_m = std::max(radius_m, point_m.norm());
  const EncoderScale scale(real);
  StringVector wound_out_m = string_lengths_m(real.geometry, {});
  scale.to_counts(wound_out_m, moves.counts[0]);
  for (size_t side = 0; side < selftest::HandMoves::kSides.size(); ++side) {
    Pose pose;
    pose.position_m = between(0.8, 1.3) * moves.distance_m *
                      (any_turn(M_PI / 18) * selftest::HandMoves::kSides[side].direction);
    pose.orientation = any_turn(0.1 * moves.distance_m / radius_m);
    const StringVector length_m = string_lengths_m(real.geometry, pose);
    wound_out_m = slack ? wound_out_m.cwiseMax(length_m) : length_m;
    scale.to_counts(wound_out_m, moves.counts[side + 1]);
  }
  return moves;
}

TEST(EncoderSigns, OfEveryProfileAreFoundAndSoAreReversedOnes) {
  std::mt19937 random(1);
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    for (int trial = 0; trial < 40; ++trial) {
      Profile real = profile;
      const auto string = static_cast<size_t>(trial % profile.geometry.count);
      if (trial >= 20) real.drives[string].encoder_sign *= -1;
      selftest::HandMoves moves = moves_of(real, trial % 2 == 0, random);
      const auto signs = selftest::encoder_signs(profile, moves);
      for (size_t k = 0; k < static_cast<size_t>(profile.geometry.count); ++k)
        ASSERT_EQ(signs[k], trial >= 20 && k == string ? selftest::EncoderSign::kReversed
                                                       : selftest::EncoderSign::kAsProfile)
            << name << ", string " << k << ", trial " << trial;
      EXPECT_EQ(selftest::encoders_agree(profile, moves), trial < 20);
      for (auto& counts : moves.counts) counts[string] = 0;
      EXPECT_EQ(selftest::encoder_signs(profile, moves)[string], selftest::EncoderSign::kStill);
      EXPECT_FALSE(selftest::encoders_agree(profile, moves));
    }
  }
}

}  // namespace
}  // namespace spidar::test::encoder_signs_test
