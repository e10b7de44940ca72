// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The force that a hand gets, compared with the limit: the simulated device's truth, not what the
/// loop believes.
#include <cstdlib>

#include <gtest/gtest.h>

#include "spidar/loop/grip_motion.h"
#include "tests/support/random_motion.h"
#include "tests/support/released_grip.h"
#include "tests/support/rest_force.h"

namespace spidar::test {
namespace {

constexpr double kReach_m = 0.02;
constexpr double kFastest_Hz = 3.7;

/// Goes about within 2 cm and 20° in sines of these frequencies, at up to 0.5 m/s.
Pose wandering(double time_s, double phase) {
  const auto wave = [&](double rate_Hz, double shift) {
    return std::sin(2 * M_PI * rate_Hz * time_s + phase + shift);
  };
  Pose pose;
  pose.position_m =
      kReach_m / std::sqrt(3.0) * Eigen::Vector3d(wave(3.1, 0), wave(2.3, 1), wave(kFastest_Hz, 2));
  const Eigen::Vector3d turn_rad =
      0.35 / std::sqrt(3.0) * Eigen::Vector3d(wave(1.3, 3), wave(0.9, 4), wave(1.1, 5));
  pose.orientation = Eigen::AngleAxisd(turn_rad.norm(), turn_rad.stableNormalized());
  return pose;
}

TEST(DeliveredLimit, HoldsInTheHand) {
  RandomMotion random(25);
  const double seconds = std::getenv("SPIDAR_SWEEP") == nullptr ? 1.5 : 60;
  double worst_N = 0;
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    const double phase = random.uniform(0, 7);
    Eigen::Vector3d force_N = Eigen::Vector3d::Zero();
    double until_s = 0;
    // Another direction every 0.1 s.
    PlayedGrip grip(profile, grip_model_of(profile), [&](double time_s) {
      for (; until_s <= time_s; until_s += 0.1) force_N = 3 * random.direction();
      return Wrench{force_N, Eigen::Vector3d::Zero()};
    });
    // The steps of the D/A converter round each string by half a step.
    double step_N = 0;
    for (int i = 0; i < profile.geometry.count; ++i)
      step_N += 0.5 * profile.dac_max_V / ((1 << profile.dac_bits) - 1) *
                profile.drives[static_cast<size_t>(i)].newtons_per_volt;
    double excess_N = 0;
    for (double time_s = 0; time_s < seconds; time_s += 1e-3) {
      grip.device.set_hand(wandering(time_s, phase));
      grip.tick();
      const FeltState felt = grip.device.felt();
      const double allowed_N = std::max(3.0, rest_force_N(profile, felt.pose).norm());
      excess_N = std::max(excess_N, felt.wrench.force_N.norm() - allowed_N);
    }
    // The loop looks at both ends of the way that the grip goes in 6 ms. Between them the direction
    // of a string is off by the square of half of that way over the string's length, at most. The
    // end itself is off by the acceleration, during that time and the lag of the velocity.
    const double length_m =
        string_lengths_m(profile.geometry, {}).head(profile.geometry.count).minCoeff();
    const double turn = 0.5 * 6e-3 * grip.fastest_m_s / length_m;
    const double late_s = 6e-3 + GripMotion::kLag_s;
    const double off_m = 0.5 * std::pow(2 * M_PI * kFastest_Hz * late_s, 2) * kReach_m;
    const double allowed_N = step_N + 3 * (turn * turn + off_m / length_m);
    worst_N = std::max(worst_N, excess_N);
    EXPECT_LE(excess_N, allowed_N) << name;
  }
  std::printf("at most %.3f N above the limit\n", worst_N);
}

}  // namespace
}  // namespace spidar::test
