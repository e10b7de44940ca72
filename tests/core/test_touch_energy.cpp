// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A surface that stands still gives a hand no more energy than it got from it.
#include "tests/support/test.h"
#include "tests/support/touch_surfaces.h"
#include "tests/support/touched_grip.h"

namespace spidar::test::touch_energy_test {
namespace {

constexpr double kBound_J = 5e-6;  // lifts the grip of 0.1 kg by 5 µm

/// Holds the grip so loosely that it bounces after a tap.
constexpr Hand kLooseHand{"loose", 30, 0.5};

/// The hand goes from 20 mm above a plane to `depth_m` below it and out again, at the same speed.
/// The largest energy that a contact gave out (below 0: absorbed), J; −∞ if the grip never touched.
double tap_J(const touch::ContactSettings& settings, const Hand& hand, double speed_m_s,
             double depth_m) {
  constexpr double kAbove_m = 0.02;
  constexpr int kFaded = 20;  // ticks, ten times the drive's lag
  static const touch::HeightField plane = plane_field(0);
  TouchedGrip grip(hand, {0, 0, kAbove_m});
  touch::ContactForce force;
  const int down = static_cast<int>((kAbove_m + depth_m) / speed_m_s / TouchedGrip::kTick_s);
  double most_J = -std::numeric_limits<double>::infinity();
  double begin_J = 0;
  bool in_contact = false;
  int ticks_away = 0;
  for (int n = 0; n < 2 * down + 400; ++n) {
    const Eigen::Vector3d wanted_N =
        force.tick({&plane}, nullptr, settings, grip.measured_m(), TouchedGrip::kTick_s);
    if (force.proxy().touching()) {
      if (!in_contact) begin_J = grip.given_J();
      in_contact = true;
      ticks_away = 0;
    } else if (in_contact && ++ticks_away == kFaded) {
      in_contact = false;
      most_J = std::max(most_J, begin_J - grip.given_J());
    }
    const double hand_m = -depth_m + speed_m_s * TouchedGrip::kTick_s * std::abs(n - down);
    grip.exchange(wanted_N, {0, 0, std::min(hand_m, kAbove_m)});
  }
  return most_J;
}

/// The largest value over taps of all speeds up to 1 m/s and of several depths.
double worst_tap_J(const touch::ContactSettings& settings, const Hand& hand) {
  double most_J = -std::numeric_limits<double>::infinity();
  for (double speed_m_s = 0.02; speed_m_s < 1; speed_m_s += 0.02) {
    for (const double depth_m : {0.001, 0.002, 0.004, 0.006, 0.010}) {
      most_J = std::max(most_J, tap_J(settings, hand, speed_m_s, depth_m));
    }
  }
  return most_J;
}

TEST(TouchEnergy, ATapGivesNoneBackHoweverFast) {
  touch::ContactSettings settings;
  for (const Hand& hand : {kFirmHand, kLightHand, kLooseHand}) {
    settings.stiffness_N_m = 500;
    EXPECT_LE(worst_tap_J(settings, hand), kBound_J) << hand.name;
    settings.stiffness_N_m = touch::ContactSettings::kMaxStiffness_N_m;
    EXPECT_LE(worst_tap_J(settings, hand), kBound_J) << hand.name;
  }
}

/// The force of a grip that goes in by 3 mm in 10 ms and then down with the surface, at the same
/// depth: before and after 5 mm.
std::pair<double, double> sink_N(double slew_N_s) {
  constexpr int kIn_ticks = 10, kRest_ticks = 40, kSink_ticks = 500;
  const touch::HeightField high = plane_field(0);
  const touch::HeightField low = plane_field(-0.005);
  touch::ContactSettings settings;
  settings.max_slew_N_s = slew_N_s;
  touch::ContactForce force;
  double before_N = 0, after_N = 0;
  for (int n = -1; n < kIn_ticks + kRest_ticks + kSink_ticks; ++n) {
    const double fraction =
        std::clamp((n - kIn_ticks - kRest_ticks) / static_cast<double>(kSink_ticks), 0.0, 1.0);
    const double depth_m = 0.003 * std::min(1.0, n / static_cast<double>(kIn_ticks));
    after_N = force
                  .tick({&high, &low, fraction}, nullptr, settings,
                        {0, 0, -0.005 * fraction - depth_m}, TouchedGrip::kTick_s)
                  .z();
    if (n == kIn_ticks + kRest_ticks - 1) before_N = after_N;
  }
  return {before_N, after_N};
}

/// Forces of a grip that rests in a surface which has taken little energy, so that the budget
/// bounds them, while ticks come as a busy machine lets them: late, and then early. `step_m` is by
/// how much the encoders count in and out in every third of them.
std::pair<double, double> least_and_most_N(bool is_busy, double step_m) {
  constexpr int kIn_ticks = 10, kRest_ticks = 200, kBusy_ticks = 400;
  constexpr double kLate_s[] = {2.5e-3, 0.2e-3, 0.3e-3, 1.8e-3, 0.2e-3, 1e-3};
  const touch::HeightField plane = plane_field(0);
  touch::ContactSettings settings;
  settings.max_slew_N_s = 20;
  touch::ContactForce force;
  std::pair<double, double> found{1e9, 0};
  for (int n = -1; n < kIn_ticks + kRest_ticks + kBusy_ticks; ++n) {
    const bool is_at_rest = n >= kIn_ticks + kRest_ticks;
    const double dt_s = is_busy && is_at_rest ? kLate_s[n % 6] : TouchedGrip::kTick_s;
    const double out_m = is_at_rest && n % 6 < 3 ? step_m : 0;
    const double depth_m = 0.003 * std::min(1.0, n / static_cast<double>(kIn_ticks));
    const double now_N = force.tick({&plane}, nullptr, settings, {0, 0, out_m - depth_m}, dt_s).z();
    if (is_at_rest) found = {std::min(found.first, now_N), std::max(found.second, now_N)};
  }
  return found;
}

/// How long ago the last tick was says nothing of how long a force is held.
TEST(TouchEnergy, TicksThatComeLateChangeNoForceAtRest) {
  const auto [least_N, most_N] = least_and_most_N(false, 0);
  EXPECT_GT(least_N, 0.05);
  EXPECT_LT(most_N, 0.5 * 1.5) << "of 500 N/m and 3 mm: the budget does bound it";
  const auto [late_least_N, late_most_N] = least_and_most_N(true, 0);
  EXPECT_NEAR(late_least_N, least_N, 1e-9);
  EXPECT_NEAR(late_most_N, most_N, 1e-9);
}

/// A step of the encoders is a velocity only over the time that it took.
TEST(TouchEnergy, TicksThatComeLateMakeNoSpeedOfAStep) {
  constexpr double kStep_m = 2.7e-6;  // of a SPIDAR-GCC along z
  const auto [least_N, most_N] = least_and_most_N(false, kStep_m);
  const auto [late_least_N, late_most_N] = least_and_most_N(true, kStep_m);
  EXPECT_LT(late_most_N - late_least_N, 2 * (most_N - least_N));
}

TEST(TouchEnergy, ASurfaceThatSinksTakesNoMoreThanTheForceThatThereIs) {
  // A force that may rise by 20 N/s has taken far less than the spring holds when the grip is in.
  const auto [before_N, after_N] = sink_N(20);
  EXPECT_GT(before_N, 0.05);
  EXPECT_LT(before_N, 0.5 * 1.5) << "of 500 N/m and 3 mm: the budget does bound it";
  // What the surface takes the hand gives. Damping of the common speed, 10 mm/s, is what is left.
  EXPECT_GT(after_N, 0.8 * before_N);
}

}  // namespace
}  // namespace spidar::test::touch_energy_test
