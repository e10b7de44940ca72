// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/chain/tension_command.h"
#include "spidar/limits/force_limits.h"
#include "spidar/limits/wrench_limits.h"
#include "tests/support/test.h"

namespace spidar::test::safety_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kTick_s = 1e-3;
// A length scaled to its limit is exact up to the roundings of norm, quotient and products.
constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();

Wrench force(double x, double y, double z) {
  return {{x, y, z}, {0, 0, 0}};
}

Profile two_strings() {
  Profile profile;
  profile.geometry.count = 2;
  profile.drives[0] = {0.3, 5.0, 2.0, 1e-5, 1, 1};
  profile.drives[1] = {0.2, 4.0, 0.5, 1e-5, -1, 1};
  profile.dac_max_V = 6.0;
  return profile;
}

TEST(LimitTotal, ShortensAndKeepsDirection) {
  const SafetyLimits limits;
  const Wrench limited = limit_total({{30, -40, 0}, {0, 0, 2}}, limits);
  EXPECT_TRUE(limited.force_N.isApprox(Eigen::Vector3d(1.8, -2.4, 0), kRounding));
  EXPECT_TRUE(limited.torque_Nm.isApprox(Eigen::Vector3d(0, 0, 0.1), kRounding));
}

TEST(LimitTotal, SurvivesAnything) {
  EXPECT_EQ(limit_total(force(kNaN, 1, 1), {}).force_N.norm(), 0);
  EXPECT_EQ(limit_total(force(kInf, 1, 1), {}).force_N.norm(), 0);
  // A sum of squares would overflow.
  EXPECT_NEAR(limit_total(force(-1e300, 0, 0), {}).force_N.x(), -3.0, 3 * kRounding);
  for (const double max : {kNaN, -1.0, 0.0, -kInf}) {
    SafetyLimits limits;
    limits.max_force_N = max;
    EXPECT_EQ(limit_total(force(1, 0, 0), limits).force_N.norm(), 0) << "max_force " << max;
  }
}

TEST(LimitSlew, ChangesByNoMoreThanTheLimit) {
  Wrench last;
  for (int i = 1; i <= 10; ++i) {
    last = limit_slew(last, limit_total({{3, 0, 0}, {0, 0, 0.1}}, {}), kTick_s, {});
    EXPECT_NEAR(last.force_N.x(), 0.3 * i, 1e-12);
    EXPECT_NEAR(last.torque_Nm.z(), 0.01 * i, 1e-12);
  }
  // There, exactly, and it stays.
  EXPECT_EQ((last = limit_slew(last, force(3, 0, 0), kTick_s, {})).force_N.x(), 3);
  // Turning round goes straight through, at the same rate.
  EXPECT_NEAR(limit_slew(last, force(-3, 0, 0), kTick_s, {}).force_N.x(), 2.7, 1e-12);
}

constexpr double kNoMost = std::numeric_limits<double>::infinity();

TEST(ForceLimits, FallFromWhatTheHandGets) {
  SafetyLimits low;
  low.max_force_N = 1;
  low.max_torque_Nm = 0;
  const Wrench commanded{{0, 1.5, 0}, {0.03, 0, 0}}, delivered{{2.5, 0, 0}, {0, 0.02, 0}};
  ForceLimits limits({}, kNoMost, kNoMost);
  limits.set(low);
  limits.begin_tick(commanded, delivered, kTick_s, kNoMost, kNoMost);
  EXPECT_NEAR(limits.in_effect().max_force_N, 2.2, 1e-12) << "from the force, not from the limit";
  EXPECT_NEAR(limits.in_effect().max_torque_Nm, 0.02, 1e-12) << "from the commanded torque";
  EXPECT_EQ(limits.as_set().max_force_N, 1);
  limits.undo();
  EXPECT_EQ(limits.in_effect().max_force_N, 3) << "the device did not receive the tick";
  limits.set({});
  limits.begin_tick(commanded, delivered, kTick_s, kNoMost, kNoMost);
  EXPECT_EQ(limits.in_effect().max_force_N, 3) << "a raised limit takes effect at once";
  limits.set(low);
  limits.begin_tick_at_rest();
  EXPECT_EQ(limits.in_effect().max_force_N, 1) << "nothing pulls";
  limits.begin_tick(commanded, 10 * delivered, kTick_s, kNoMost, kNoMost);
  EXPECT_EQ(limits.in_effect().max_force_N, 1) << "a force above its limit raises no limit";
  low.max_force_N = kNaN;
  limits.set(low);
  for (int i = 0; i < 100; ++i) limits.begin_tick({}, {}, kTick_s, kNoMost, kNoMost);
  EXPECT_EQ(limits.in_effect().max_force_N, 0);
  low.max_force_N = 100;
  low.max_torque_Nm = 1;
  ForceLimits bounded(low, 10, 0.2);
  EXPECT_EQ(bounded.in_effect().max_force_N, 10);
  EXPECT_EQ(bounded.in_effect().max_torque_Nm, 0.2);
  bounded.begin_tick({}, {}, kTick_s, 5, 0.1);
  bounded.begin_tick({}, {}, kTick_s, 5, 0.1);
  EXPECT_EQ(bounded.in_effect().max_force_N, 5);
  EXPECT_EQ(bounded.in_effect().max_torque_Nm, 0.1);
}

// Away from the centre the strings at rest pull, and that stays.
TEST(ForceLimits, EndAtWhatWasSetWhateverTheStringsExertAtRest) {
  SafetyLimits low;
  low.max_force_N = 0.1;
  low.max_torque_Nm = 0.001;
  ForceLimits limits({}, kNoMost, kNoMost);
  limits.set(low);
  const Wrench at_rest{{0, 0.5, 0}, {0.02, 0, 0}};
  for (int i = 0; i < 10; ++i) limits.begin_tick({}, at_rest, kTick_s, kNoMost, kNoMost);
  EXPECT_EQ(limits.in_effect().max_force_N, 0.1);
  EXPECT_EQ(limits.in_effect().max_torque_Nm, 0.001);
}

// A force that turned aside on its way down would be above the limit that falls beside it.
TEST(LimitSlew, WhatIsAboveItsLimitComesStraightDown) {
  Wrench last;
  last = force(3, 0, 0);
  SafetyLimits low;
  low.max_force_N = 1;
  const double step_N = kTick_s * low.max_slew_N_s;
  for (int i = 1; i <= 6; ++i) {
    last = limit_slew(last, force(0, 1, 0), kTick_s, low);
    EXPECT_NEAR((last.force_N - force(3 - i * step_N, 0, 0).force_N).norm(), 0, 1e-12);
  }
  // 0.2 N are left of the seventh step, and 0.1 N of it for the turn.
  const Eigen::Vector3d then_N = limit_slew(last, force(0, 1, 0), kTick_s, low).force_N;
  EXPECT_NEAR((then_N - Eigen::Vector3d(1, 0, 0)).norm(), 0.1, 1e-12);
  EXPECT_LE(then_N.norm(), 1);
}

TEST(LimitSlew, NoTimeNoStep) {
  Wrench last;
  for (const double dt : {0.0, -1.0, kNaN}) {
    EXPECT_EQ(limit_slew(last, force(3, 0, 0), dt, {}).force_N.norm(), 0) << "dt " << dt;
  }
  SafetyLimits unlimited;
  unlimited.max_slew_N_s = kInf;
  EXPECT_EQ(limit_slew(last, force(3, 0, 0), kTick_s, unlimited).force_N.x(), 3);
}

TEST(LimitSlew, IgnoresWhatIsNotFinite) {
  Wrench last;
  last = force(1, 0, 0);
  for (const double bad : {kNaN, kInf}) {
    EXPECT_EQ(limit_slew(last, force(bad, 0, 0), kTick_s, {}).force_N.x(), 1) << bad;
  }
}

TEST(StaleRamp, TakesRampSecondsEachWay) {
  StaleRamp ramp;
  EXPECT_EQ(ramp.fraction(), 0);
  const auto fraction = [](int i) { return i * i * (120 - 2.0 * i) / (40 * 40 * 40); };
  for (int i = 1; i <= 40; ++i) EXPECT_NEAR(ramp.apply(true, kTick_s, {}), fraction(i), 1e-12);
  EXPECT_EQ(ramp.apply(true, kTick_s, {}), 1);
  for (int i = 39; i >= 0; --i) EXPECT_NEAR(ramp.apply(false, kTick_s, {}), fraction(i), 1e-12);
  EXPECT_EQ(ramp.apply(false, kTick_s, {}), 0);
}

TEST(StaleRamp, SurvivesAnything) {
  StaleRamp ramp;
  EXPECT_EQ(ramp.apply(true, kNaN, {}), 0);
  EXPECT_EQ(ramp.apply(true, -1, {}), 0);
  EXPECT_EQ(ramp.apply(true, kInf, {}), 1);
  SafetyLimits at_once;
  at_once.ramp_s = 0;
  EXPECT_EQ(ramp.apply(false, 0, at_once), 0);
  at_once.ramp_s = kNaN;
  EXPECT_EQ(ramp.apply(true, 0, at_once), 1);
}

TEST(WrenchLimits, LeavesNothingOfBefore) {
  WrenchLimits safety;
  for (int i = 0; i < 100; ++i) safety.apply(force(3, 0, 0), true, kTick_s, {});
  for (int i = 0; i < 41; ++i) safety.apply(force(3, 0, 0), false, kTick_s, {});
  // To the left at once: no rest of the force to the right is ramped in.
  for (int i = 0; i < 100; ++i) {
    EXPECT_LE(safety.apply(force(-3, 0, 0), true, kTick_s, {}).force_N.x(), 0) << "tick " << i;
  }
}

TEST(WrenchLimits, RestsInTimeHoweverLowTheSlewLimit) {
  SafetyLimits limits;
  WrenchLimits safety;
  for (int i = 0; i < 100; ++i) safety.apply(force(3, 0, 0), true, kTick_s, limits);
  limits.max_slew_N_s = 1;
  Wrench commanded;
  // One tick more than ramp_s for the rounding of the sum of steps.
  for (int i = 0; i < 41; ++i) commanded = safety.apply(force(3, 0, 0), false, kTick_s, limits);
  EXPECT_EQ(commanded.force_N.norm(), 0);
}

TEST(WrenchLimits, WhatWasNotSentIsUndone) {
  WrenchLimits safety;
  for (int i = 0; i < 20; ++i) safety.apply(force(1, 0, 0), true, kTick_s, {});
  const Wrench once = safety.apply(force(1, 0, 0), true, kTick_s, {});
  for (int i = 0; i < 5; ++i) {
    safety.undo();
    EXPECT_EQ(safety.apply(force(1, 0, 0), true, kTick_s, {}).force_N, once.force_N) << i;
  }
}

TEST(WrenchLimits, HoldsItsLimitsForAnySequence) {
  constexpr int kSeed = 20240501;
  std::mt19937_64 random(kSeed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  WrenchLimits safety;
  SafetyLimits limits;
  double largest_N = limits.max_force_N;  // ever allowed
  bool fresh = false;
  Wrench wanted;
  Wrench last;
  for (int i = 0; i < 200'000; ++i) {
    if (uniform(0, 1) < 0.02) fresh = !fresh;
    if (uniform(0, 1) < 0.05) {
      const double size = std::pow(10, uniform(-3, 3));
      wanted = {{uniform(-size, size), uniform(-size, size), uniform(-size, size)},
                {uniform(-size, size), uniform(-size, size), uniform(-size, size)}};
      if (uniform(0, 1) < 0.1) wanted.force_N.y() = uniform(0, 1) < 0.5 ? kNaN : kInf;
    }
    if (uniform(0, 1) < 0.005) {
      limits.max_force_N = uniform(0, 6);
      limits.max_slew_N_s = uniform(10, 1000);
      largest_N = std::max(largest_N, limits.max_force_N);
    }
    const double dt_s = uniform(0, 1) < 0.1 ? 0 : uniform(0, 2e-3);
    const Wrench commanded = safety.apply(limit_total(wanted, limits), fresh, dt_s, limits);

    ASSERT_TRUE(commanded.is_finite()) << "seed " << kSeed << " call " << i;
    // Above a limit that was lowered, only on the way to it.
    ASSERT_LE(commanded.force_N.norm(),
              std::max(limits.max_force_N, last.force_N.norm()) * (1 + kRounding))
        << "seed " << kSeed << " call " << i;
    ASSERT_LE(commanded.torque_Nm.norm(), limits.max_torque_Nm * (1 + kRounding))
        << "seed " << kSeed << " call " << i;
    // Fresh: the slew limit. Stale: from at most what was ever allowed to zero in ramp_s, or at the
    // slew limit to a limit that was lowered.
    const double ramp_N_s = fresh ? 0 : StaleRamp::kSteepest * largest_N / limits.ramp_s;
    const double rate_N_s = std::max(limits.max_slew_N_s, ramp_N_s);
    ASSERT_LE((commanded.force_N - last.force_N).norm(), rate_N_s * dt_s + 1e-12)
        << "seed " << kSeed << " call " << i;
    last = commanded;
  }
}

StringVector two_tensions(double first_N, double second_N) {
  StringVector tension_N = StringVector::Zero();
  tension_N.head<2>() << first_N, second_N;
  return tension_N;
}

TEST(TensionSlew, LeavesSmallChanges) {
  const Profile profile = two_strings();
  TensionSlew slew(profile);
  // 300 N/s.
  const StringVector near_rest = two_tensions(0.3 + 0.23, 0.2 + 0.18);
  EXPECT_EQ(slew.apply(near_rest, profile, kTick_s), near_rest);
}

TEST(TensionSlew, TakesItsTimeAndAllStringsGoTheSameFraction) {
  // The first string through its whole range: 12 N in 20 ms, but 4.7 N at the pace of a wrench.
  for (const auto& [most_N, fraction] : {std::pair(12.3, 1 / 20.0), std::pair(5.0, 0.3 / 4.7)}) {
    Profile profile = two_strings();
    profile.drives[0].max_tension_N = most_N;
    TensionSlew slew(profile);
    const StringVector rest = two_tensions(0.3, 0.2);
    const StringVector wanted = two_tensions(most_N, 1.2);
    for (int tick = 1; tick <= 15; ++tick) {
      const StringVector now = slew.apply(wanted, profile, kTick_s);
      const StringVector expected = rest + tick * fraction * (wanted - rest);
      // Each tick rounds a fraction and a sum.
      EXPECT_LT((now - expected).norm(),
                tick * 4 * std::numeric_limits<double>::epsilon() * most_N);
    }
    for (int tick = 16; tick <= 20; ++tick) slew.apply(wanted, profile, kTick_s);
    EXPECT_LT((slew.apply(wanted, profile, kTick_s) - wanted).norm(), kRounding * most_N);
  }
}

TEST(TensionSlew, WrenchStaysBetweenThatOfBeforeAndTheWanted) {
  // A linear function of tensions: what is true of one is true of each component of W t.
  const Profile profile = two_strings();
  TensionSlew slew(profile);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> tension(0.3, 4.0);
  StringVector last = two_tensions(0.3, 0.2);
  for (int tick = 0; tick < 1000; ++tick) {
    const StringVector wanted = two_tensions(tension(random), tension(random));
    const StringVector now = slew.apply(wanted, profile, kTick_s);
    const auto pull = [](const StringVector& t) { return t[0] - 0.7 * t[1]; };
    const double low = std::min(pull(last), pull(wanted));
    const double high = std::max(pull(last), pull(wanted));
    EXPECT_GE(pull(now), low - kRounding * 8) << "tick " << tick;
    EXPECT_LE(pull(now), high + kRounding * 8) << "tick " << tick;
    last = now;
  }
}

TEST(TensionSlew, TakesNotANumberForTheMinimum) {
  const Profile profile = two_strings();
  TensionSlew slew(profile);
  EXPECT_EQ(slew.apply(two_tensions(kNaN, kInf), profile, kTick_s), two_tensions(0.3, 0.2));
  EXPECT_EQ(slew.apply(two_tensions(5, 4), profile, kNaN), two_tensions(0.3, 0.2));
}

TEST(BoundTensions, KeepsEveryStringInItsRange) {
  const StringVector bounded = bound_tensions(two_tensions(7, -1), two_strings());
  EXPECT_EQ(bounded, two_tensions(5.0, 0));
  EXPECT_EQ(bound_tensions(two_tensions(kNaN, kInf), two_strings()), two_tensions(0, 4.0));
}

TEST(ToVolts, UsesGainSignAndRange) {
  StringVector tension = StringVector::Zero();
  tension[0] = 5;
  tension[1] = 1;
  MotorVolts volts = to_volts(tension, two_strings());
  EXPECT_EQ(volts.volt[0], 2.5);
  EXPECT_EQ(volts.volt[1], -2.0);
  EXPECT_EQ(volts.volt[2], 0);
  tension[0] = 50;
  tension[1] = 50;
  volts = to_volts(tension, two_strings());
  EXPECT_EQ(volts.volt[0], 6.0);
  EXPECT_EQ(volts.volt[1], -6.0);
  tension[0] = kNaN;
  tension[1] = -1;
  volts = to_volts(tension, two_strings());
  EXPECT_EQ(volts.volt[0], 0);
  EXPECT_EQ(volts.volt[1], 0);
}

}  // namespace
}  // namespace spidar::test::safety_test
