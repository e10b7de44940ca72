// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A surface that stands still gives a hand no more energy than it got from it.
#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/tap.h"
#include "tests/support/touch_surfaces.h"
#include "tests/support/touched_grip.h"

namespace spidar::test::touch_energy_test {
namespace {

/// For each scene and hand.
constexpr long kTicks = 30'000;

ContactEnergy explore_all(const ContactSettings& settings, bool with_texture) {
  ContactEnergy all;
  for (const TouchScene& scene : touch_scenes()) {
    for (const Hand& hand : {kFirmHand, kLightHand}) {
      const ContactEnergy energy = explore({&scene.relief}, with_texture ? &scene.texture : nullptr,
                                           settings, hand, kTicks, 7);
      EXPECT_GE(energy.contacts, 5) << scene.name << ", " << hand.name;
      all.contacts += energy.contacts;
      all.generating += energy.generating;
      all.worst_J = std::max(all.worst_J, energy.worst_J);
    }
  }
  return all;
}

// 0.005 mJ lift the grip of 0.1 kg by 5 µm, 0.1 mJ by 0.1 mm.
constexpr double kBound_J = 5e-6;
constexpr double kStiffBound_J = 1e-4;

TEST(TouchEnergy, NoContactGivesAnyOutByDefault) {
  ContactSettings settings;
  EXPECT_LE(explore_all(settings, false).worst_J, kBound_J);
  settings.friction = {0.3, 0.24};
  EXPECT_LE(explore_all(settings, false).worst_J, kBound_J) << "with friction";
  EXPECT_LE(explore_all(settings, true).worst_J, kBound_J) << "with texture";
}

TEST(TouchEnergy, NoContactGivesMuchOutWhereItIsStiffest) {
  ContactSettings settings;
  settings.stiffness_N_m = ContactSettings::kMostStiffness_N_m;
  settings.friction = {0.3, 0.24};
  EXPECT_LE(explore_all(settings, false).worst_J, kStiffBound_J);
  EXPECT_LE(explore_all(settings, true).worst_J, kStiffBound_J) << "with texture";
}

TEST(TouchEnergy, ATapGivesNoneBackHoweverFast) {
  ContactSettings settings;
  for (const Hand& hand : {kFirmHand, kLightHand, kLooseHand}) {
    settings.stiffness_N_m = 500;
    EXPECT_LE(worst_tap_J(settings, hand), kBound_J) << hand.name;
    settings.stiffness_N_m = ContactSettings::kMostStiffness_N_m;
    EXPECT_LE(worst_tap_J(settings, hand), kBound_J) << hand.name;
  }
}

TEST(TouchEnergy, OfFastTapsItIsSeenWithoutTheBudget) {
  ContactSettings settings;
  settings.bounds_energy = false;
  EXPECT_GT(worst_tap_J(settings, kLightHand), kStiffBound_J);
  settings.stiffness_N_m = ContactSettings::kMostStiffness_N_m;
  EXPECT_GT(worst_tap_J(settings, kFirmHand), kStiffBound_J);
  EXPECT_GT(worst_tap_J(settings, kLightHand), 10 * kStiffBound_J);
}

/// The force of a grip that goes in by 3 mm in 10 ms and then down with the surface, at the same
/// depth: before and after 5 mm.
std::pair<double, double> sink_N(double slew_N_s) {
  constexpr int kIn_ticks = 10, kRest_ticks = 40, kSink_ticks = 500;
  const HeightField high = plane_field(0);
  const HeightField low = plane_field(-0.005);
  ContactSettings settings;
  settings.max_slew_N_s = slew_N_s;
  ContactForce force;
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
