// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/chain/tension_command.h"
#include "tests/spidar/loop_driver.h"
#include "tests/support/test.h"

namespace spidar::test::motor_heat_test {
namespace {

constexpr double kStep_s = 1e-3;

TEST(MotorHeat, EveryProfileHasARating) {
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    for (int i = 0; i < profile.geometry.count; ++i) {
      const StringDrive& drive = profile.drives[static_cast<size_t>(i)];
      EXPECT_GE(drive.continuous_tension_N, 3 * drive.min_tension_N) << name;
      EXPECT_LE(drive.continuous_tension_N, drive.max_tension_N) << name;
    }
    bool marked = false;
    for (const Provenance& row : profile.provenance)
      marked |= row.field == "continuous_tension_N" && row.evidence == Evidence::kInferred;
    EXPECT_TRUE(marked) << name << ": no source publishes a rating";
  }
}

// The step response of a body of one time constant: after t it has (F/F_cont)² (1 − e^(−t/τ)).
TEST(MotorHeat, RisesWithTheSquareOfTheTension) {
  const Profile profile = load_profile(kDefaultProfile);
  const double continuous_N = profile.drives[0].continuous_tension_N;
  const double tau_s = profile.drives[0].heating_time_s;
  MotorHeat heat(profile);
  StringVector tension_N = StringVector::Zero();
  tension_N[2] = 1.5 * continuous_N;
  const int ticks = static_cast<int>(0.3 * tau_s / kStep_s);
  for (int i = 0; i < ticks; ++i) heat.update(tension_N, kStep_s);
  // The forward difference errs by half a step: dt / 2τ of the slope.
  EXPECT_NEAR(heat.hottest(), 1.5 * 1.5 * (1 - std::exp(-0.3)), 1.5 * 1.5 * kStep_s / tau_s);
  EXPECT_EQ(heat.limit_N()[0], profile.max_tension_N()[0]);
}

TEST(MotorHeat, NeverAboveOneWithinTheLimit) {
  for (const std::string& name : list_profiles()) {
    const Profile profile = load_profile(name);
    MotorHeat heat(profile);
    StringVector last_N = heat.limit_N();
    for (int i = 0; i < 200'000; ++i) {
      const StringVector limit_N = heat.limit_N();
      ASSERT_LE((limit_N - last_N).cwiseAbs().maxCoeff(), 0.01 * profile.max_tension_N().maxCoeff())
          << "less force comes gradually";
      heat.update(limit_N, kStep_s);
      last_N = limit_N;
      ASSERT_LE(heat.hottest(), 1 + 1e-12) << name;
    }
    EXPECT_GT(heat.hottest(), 0.99 * MotorHeat::kLimitFrom) << name;
  }
}

TEST(MotorHeat, TheLoopReducesTheForceInsteadOfOverheating) {
  SafetyLimits limits;
  limits.max_force_N = 5;
  LoopDriver driver(limits);
  driver.open();
  driver.loop->schedule({0, INT64_MAX / 2, push_right(5)});
  driver.play(0);
  // The fake grip does not move, but its counters do: a hand trembles.
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      driver.log().count[0] = i / 100 % 2;
      driver.tick();
    }
    return driver.loop->snapshot();
  };
  const double cold_N = run(500).last.delivered.force_N.x();
  EXPECT_GT(cold_N, 4.9);
  EXPECT_FALSE(driver.loop->snapshot().last.held_back);
  const LoopSnapshot warm = run(120'000);
  EXPECT_TRUE(warm.last.held_back);
  EXPECT_GT(warm.counters.held_back_ticks, 60'000u);
  EXPECT_LE(warm.last.motor_heat, 1);
  EXPECT_LT(warm.last.delivered.force_N.x(), 0.9 * cold_N);
  EXPECT_GT(warm.last.delivered.force_N.x(), 0.3 * cold_N);
  // What is left goes where it is wanted.
  EXPECT_LT(warm.last.delivered.force_N.tail<2>().norm(), 0.1 * warm.last.delivered.force_N.x());
  // It cools at rest, and then gives it all again.
  driver.pause();
  run(60'000);
  driver.play(0);
  EXPECT_GT(run(500).last.delivered.force_N.x(), 4.9);
}

}  // namespace
}  // namespace spidar::test::motor_heat_test
