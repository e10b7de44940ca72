// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A surface that stands still gives a hand no more energy than it got from it, through pose solver,
// safety chain, tension solver, D/A steps and strings, and beside a film.
#include "spidar/touch/touch_rendering.h"
#include "tests/support/test.h"
#include "tests/support/touched_strings.h"

namespace spidar::test::touch_strings_test {
namespace {

/// For each scene and hand; spidar-bench touch_strings runs a million.
constexpr long kTicks = 15'000;
// As in test_touch_energy.cpp.
constexpr double kBound_J = 5e-6;
constexpr double kStiffBound_J = 1e-4;

ContactEnergy explore_all(const StringTouch& touch,
                          const std::vector<Hand>& hands = {kFirmHand, kLightHand}) {
  ContactEnergy all;
  for (const TouchScene& scene : touch_scenes()) {
    for (const Hand& hand : hands) {
      const ContactEnergy energy = explore_through_strings(scene, touch, hand, kTicks, 7);
      EXPECT_GE(energy.contacts, 3) << scene.name << ", " << hand.name;
      all.contacts += energy.contacts;
      all.generating += energy.generating;
      all.worst_J = std::max(all.worst_J, energy.worst_J);
    }
  }
  return all;
}

StringTouch touch_of(double stiffness_N_m) {
  StringTouch touch;
  touch.contact.stiffness_N_m = stiffness_N_m;
  touch.contact.friction = 0.3;
  return touch;
}

TEST(TouchStrings, NoContactGivesAnyOut) {
  StringTouch touch = touch_of(500);
  EXPECT_LE(explore_all(touch).worst_J, kBound_J);
  touch.texture = true;
  EXPECT_LE(explore_all(touch).worst_J, kBound_J) << "with texture";
  touch = touch_of(touch::ContactSettings::kMaxStiffness_N_m);
  EXPECT_LE(explore_all(touch).worst_J, kStiffBound_J) << "where it is stiffest";
}

TEST(TouchStrings, NoContactAddsAnyToAFilm) {
  StringTouch touch = touch_of(500);
  touch.film_N = 1;
  EXPECT_LE(explore_all(touch).worst_J, kBound_J);
  // A film that takes all of max-force. In a light hand a few contacts beside it do give some out
  // (docs/strings.md).
  touch.film_N = 3;
  EXPECT_LE(explore_all(touch, {kFirmHand}).worst_J, kBound_J);
}

ContactEnergy push_into_wall(double stiffness_N_m, bool passive, const Hand& hand) {
  StringTouch touch;
  touch.wall_N_m = stiffness_N_m;
  touch.passive = passive;
  return explore_through_strings(touch_scenes().front(), touch, hand, 15'000, 7);
}

TEST(TouchStrings, APassiveWallOfACallbackGivesTheHandNoEnergy) {
  for (const Hand& hand : {kFirmHand, kLightHand}) {
    for (const double stiffness_N_m : {200.0, 500.0, 800.0}) {
      const ContactEnergy passive = push_into_wall(stiffness_N_m, true, hand);
      EXPECT_GE(passive.contacts, 3);
      EXPECT_LE(passive.worst_J, kBound_J) << hand.name << ", " << stiffness_N_m;
    }
  }
  // A plain spring does.
  EXPECT_GT(push_into_wall(800, false, kLightHand).worst_J, kStiffBound_J);
}

/// Away from the centre the tensions at rest pull the grip back. A light touch must not take that
/// away on the way out.
TEST(TouchStrings, ALightTouchOnTheWayOutGivesNothing) {
  const TouchScene plane{"plane", plane_field(-0.002), plane_field(0)};
  StringTouch touch = touch_of(500);
  touch.contact.friction = 0;
  constexpr double kRound_s = 3;
  const ContactEnergy energy =
      touch_through_strings(plane, touch, kLightHand, 10'000, [](double time_s) {
        // Out along x in the surface, by 18 mm in 2 s, and back above it. The light hand and 500
        // N/m make 0.04 N of 0.5 mm.
        const double part_s = std::fmod(time_s, kRound_s);
        const bool out = part_s < 2;
        const double x_m = out ? 0.009 * part_s : 0.018 * (kRound_s - part_s);
        return Eigen::Vector3d(x_m, 0, out ? -0.0025 : 0.0);
      });
  EXPECT_GE(energy.contacts, 2);
  EXPECT_LE(energy.worst_J, kBound_J);
}

/// Of a hand that explores a plane with 800 N/m for so many ticks.
double fraction_after(const Hand& hand, double mass_kg, double more_lag_s, long ticks = 15'000) {
  StringTouch touch = touch_of(touch::ContactSettings::kMaxStiffness_N_m);
  touch.mass_kg = mass_kg;
  touch.more_lag_s = more_lag_s;
  const TouchScene plane{"plane", plane_field(-0.002), plane_field(0)};
  return explore_through_strings(plane, touch, hand, ticks, 7).stiffness_fraction;
}

TEST(TouchStrings, ASurfaceThatShakesBecomesSofter) {
  constexpr Hand kLooseHand{"loose", 30, 0.5};
  for (const double mass_kg : {0.05, 0.1}) {
    EXPECT_LT(fraction_after(kLooseHand, mass_kg, 0.003), 1) << mass_kg << " kg";
    EXPECT_EQ(fraction_after(kLooseHand, mass_kg, 0), 1) << mass_kg << " kg";
    EXPECT_EQ(fraction_after(kLightHand, mass_kg, 0), 1) << mass_kg << " kg";
    EXPECT_EQ(fraction_after(kFirmHand, mass_kg, 0.003), 1) << mass_kg << " kg";
  }
}

/// What is left of the stiffness after a second of this velocity across the surface, and this one
/// along it.
template <typename Velocity>
double fraction_of(Velocity across_m_s, double along_m_s = 0) {
  touch::ShakeWatch watch;
  for (int i = 0; i < 1000; ++i)
    watch.update({along_m_s, 0, across_m_s(1e-3 * i)}, Eigen::Vector3d::UnitZ(), 1e-3);
  return watch.fraction();
}

TEST(ShakeWatch, NoticesShakingAndNothingElse) {
  const auto sine = [](double rate_Hz, double size_m_s) {
    return [=](double time_s) { return size_m_s * std::sin(2 * M_PI * rate_Hz * time_s); };
  };
  for (const double rate_Hz : {18.0, 25.0, 40.0, 55.0}) {
    EXPECT_LT(fraction_of(sine(rate_Hz, 0.02)), 1) << rate_Hz;
    // The slow part that is left out takes at most a third at 18 Hz.
    EXPECT_EQ(fraction_of(sine(rate_Hz, 0.75 * touch::ShakeWatch::kMin_m_s)), 1) << rate_Hz;
    EXPECT_EQ(fraction_of(sine(rate_Hz, 0.02), 2 * touch::ShakeWatch::kStroke_m_s), 1) << "strokes";
  }
  // A hand trembles at 8 to 12 Hz; what is faster than 60 Hz is no motion of the grip.
  for (const double rate_Hz : {1.0, 8.0, 12.0, 80.0})
    EXPECT_EQ(fraction_of(sine(rate_Hz, 0.02)), 1);
  // A tap every 0.2 s.
  const auto taps = [](double time_s) {
    const double since_s = std::fmod(time_s, 0.2);
    return 0.3 * std::exp(-since_s / 0.01) * std::cos(2 * M_PI * 25 * since_s);
  };
  EXPECT_EQ(fraction_of(taps), 1);
  // It shakes on: the stiffness falls on, to a tenth.
  touch::ShakeWatch watch;
  for (int i = 0; i < 10'000; ++i)
    watch.update({0, 0, 0.02 * std::sin(2 * M_PI * 0.025 * i)}, Eigen::Vector3d::UnitZ(), 1e-3);
  EXPECT_EQ(watch.fraction(), touch::ShakeWatch::kMinFraction);
}

}  // namespace
}  // namespace spidar::test::touch_strings_test
