// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/selftest/encoder_signs.h"

#include <algorithm>

namespace spidar::selftest {
namespace {

constexpr double kLargestMove_m = 0.03;
constexpr double kFractionOfFrame = 0.3;
/// A hand misses distance and direction, and turns the grip a little.
constexpr double kPaidOut = 0.4;

}  // namespace

const std::array<HandMoves::Side, 6> HandMoves::kSides{{{"to the right", {1, 0, 0}},
                                                        {"to the left", {-1, 0, 0}},
                                                        {"up", {0, 1, 0}},
                                                        {"down", {0, -1, 0}},
                                                        {"towards you", {0, 0, 1}},
                                                        {"away from you", {0, 0, -1}}}};

double hand_move_m(const StringGeometry& geometry) {
  return std::min(kLargestMove_m, kFractionOfFrame * half_frame_m(geometry).minCoeff());
}

std::array<EncoderSign, kMaxStrings> encoder_signs(const Profile& profile, const HandMoves& moves) {
  const EncoderScale scale(profile);
  const double paid_out_m = kPaidOut * moves.distance_m;
  const StringVector centre_m = scale.lengths_m(moves.counts[0]);
  std::array<bool, kMaxStrings> longer{}, shorter{};
  for (size_t side = 0; side < HandMoves::kSides.size(); ++side) {
    Pose pose;
    pose.position_m = moves.distance_m * HandMoves::kSides[side].direction;
    const StringVector expected_m =
        string_lengths_m(profile.geometry, pose) - string_lengths_m(profile.geometry, {});
    const StringVector change_m = scale.lengths_m(moves.counts[side + 1]) - centre_m;
    for (int i = 0; i < profile.geometry.count; ++i) {
      if (expected_m[i] < paid_out_m) continue;
      const auto k = static_cast<size_t>(i);
      longer[k] = longer[k] || change_m[i] >= paid_out_m / 2;
      shorter[k] = shorter[k] || change_m[i] <= -paid_out_m / 2;
    }
  }
  std::array<EncoderSign, kMaxStrings> signs{};
  for (size_t k = 0; k < signs.size(); ++k) {
    if (longer[k] && shorter[k]) {
      signs[k] = EncoderSign::kUnclear;
    } else if (longer[k]) {
      signs[k] = EncoderSign::kAsProfile;
    } else {
      signs[k] = shorter[k] ? EncoderSign::kReversed : EncoderSign::kStill;
    }
  }
  return signs;
}

bool encoders_agree(const Profile& profile, const HandMoves& moves) {
  const auto signs = encoder_signs(profile, moves);
  return std::all_of(signs.begin(), signs.begin() + profile.geometry.count,
                     [](EncoderSign sign) { return sign == EncoderSign::kAsProfile; });
}

}  // namespace spidar::selftest
