// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which force acts when: playback, flush, limits.
#include "spidar/limits/released_grip.h"
#include "tests/spidar/loop_driver.h"
#include "tests/support/tampered_device.h"
#include "tests/support/test.h"
#include "tests/support/tick_watch.h"

namespace spidar::test::haptic_loop_test {
namespace {

constexpr int64_t kFrame = 40 * kMs;
// One tick more than ramp_s for the rounding of the sum of its steps.
const int64_t kRamp = static_cast<int64_t>(SafetyLimits{}.ramp_s * 1e9) + kMs;

TimedWrench frame(int64_t time_ns, const Wrench& wrench) {
  return {time_ns, kFrame, wrench};
}

/// Open, with frames that push to the right with 1 N for two seconds, of which the first is due.
struct Playing : LoopDriver {
  Playing() {
    open();
    for (int i = 0; i < 50; ++i) loop->schedule(frame(i * kFrame, push_right(1)));
    play(0);
  }
};

TEST(HapticLoop, NoForceBeforePlaying) {
  LoopDriver driver;
  driver.open();
  driver.loop->schedule(frame(0, push_right(2)));
  driver.pause();
  for (int i = 0; i < 500; ++i) {
    const TickRecord record = driver.tick();
    ASSERT_EQ(record.commanded.stacked().norm(), 0) << "tick " << i;
    ASSERT_EQ(record.found, Found::kNothing);
    ASSERT_FALSE(record.playing);
  }
}

TEST(HapticLoop, NoForceWithoutAClock) {
  Playing driver;
  for (const double rate : {0.0, -1.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    driver.loop->set_playback_clock({driver.now_ns, 0, rate, true});
    EXPECT_EQ(driver.run(kRamp).commanded.stacked().norm(), 0) << "rate " << rate;
    EXPECT_FALSE(driver.tick().playing) << "rate " << rate;
  }
}

TEST(HapticLoop, CommandsWhatIsWanted) {
  Playing driver;
  const TickRecord record = driver.run(2 * kRamp);
  EXPECT_EQ(record.commanded.stacked(), record.wanted.stacked());
  EXPECT_EQ(record.commanded.force_N.x(), 1);
  EXPECT_EQ(record.device, DeviceState::kRunning);

  // The strings get what the record says.
  const StructureMatrix W = structure_matrix(driver.profile.geometry, Pose{});
  EXPECT_LE((W * record.tension_N - record.delivered.stacked()).norm(), 1e-12);
  const MotorVolts expected = to_volts(record.tension_N, driver.profile);
  EXPECT_EQ(driver.log().last_volts.volt, expected.volt);

  // And they can do it at the centre. The solver trades residual against tension: at its optimum
  // 0.5 |r|² ≤ 0.5 ε |t − t_ref|² for any t that balances f exactly, so |r| ≤ sqrt(ε) |t − t_ref|
  // with |t − t_ref| below the sum of all ranges.
  const double most_N = (driver.profile.max_tension_N() - driver.profile.min_tension_N()).norm();
  EXPECT_LE((record.delivered.force_N - record.commanded.force_N).norm(),
            std::sqrt(TensionProblem{}.epsilon) * most_N);
}

TEST(HapticLoop, PauseRampsToRest) {
  Playing driver;
  Wrench last = driver.run(5 * kFrame).commanded;
  ASSERT_EQ(last.force_N.x(), 1);
  driver.pause();
  const double step_N = StaleRamp::kSteepest / (SafetyLimits{}.ramp_s / 1e-3);
  const int64_t paused = driver.now_ns;
  while (driver.now_ns < paused + kRamp) {
    const Wrench commanded = driver.tick().commanded;
    ASSERT_LE(commanded.force_N.x(), last.force_N.x());
    ASSERT_LE(last.force_N.x() - commanded.force_N.x(), step_N + 1e-12);
    last = commanded;
  }
  EXPECT_EQ(last.stacked().norm(), 0);
  // Playing on from there.
  driver.play(5 * kFrame);
  EXPECT_EQ(driver.run(2 * kRamp).commanded.force_N.x(), 1);
}

TEST(HapticLoop, FlushForgets) {
  Playing driver;
  double last_N = driver.run(5 * kFrame).commanded.force_N.x();
  driver.loop->cancel_scheduled();
  EXPECT_EQ(driver.tick().found, Found::kNothing);
  const double step_N = StaleRamp::kSteepest / (SafetyLimits{}.ramp_s / 1e-3);
  for (int i = 0; i < 200; ++i) {
    const TickRecord record = driver.tick();
    ASSERT_LE(last_N - record.commanded.force_N.x(), 2 * step_N + 1e-12) << "a step at tick " << i;
    last_N = record.commanded.force_N.x();
    if (i * kMs > kRamp) {
      ASSERT_EQ(last_N, 0);
    }
  }
  // A seek goes on at any running time, also an earlier one.
  driver.loop->schedule(frame(0, push_right(-1)));
  driver.loop->schedule(frame(kFrame, push_right(-1)));
  driver.play(0);
  for (int i = 0; i < 40; ++i) ASSERT_LE(driver.tick().commanded.force_N.x(), 0);
  EXPECT_LT(driver.tick().commanded.force_N.x(), -0.9);
}

TEST(HapticLoop, FlushForgetsWhatTheLoopHasNotSeen) {
  LoopDriver driver;
  driver.open();
  driver.loop->schedule(frame(0, push_right(1)));
  driver.loop->cancel_scheduled();
  driver.loop->schedule(frame(10 * kMs, push_right(-2)));
  driver.play(10 * kMs);
  const TickRecord record = driver.tick();
  EXPECT_EQ(record.frame_ns, 10 * kMs);
  EXPECT_EQ(record.wanted.force_N.x(), -2);
}

TEST(HapticLoop, LongQueueBeforeTheScreen) {
  LoopDriver driver;
  driver.open();
  // Far more frames ahead than the timeline keeps.
  constexpr int kAhead = 3 * WrenchTimeline::kCapacity;
  for (int i = 0; i < kAhead; ++i) {
    ASSERT_TRUE(driver.loop->schedule(frame(i * kFrame, push_right(0.01 * i))));
  }
  driver.play(0);
  for (int i = 1; i < kAhead; ++i) {
    const TickRecord record = driver.run(kFrame);
    ASSERT_EQ(record.found, Found::kExact) << "frame " << i;
    ASSERT_EQ(record.running_ns, i * kFrame);
    ASSERT_EQ(record.frame_ns, i * kFrame);
    ASSERT_EQ(record.wanted.force_N.x(), 0.01 * i) << "frame " << i;
  }
}

TEST(HapticLoop, OfAThousandFramesASecondNoneIsMissed) {
  LoopDriver driver;
  driver.open();
  for (int i = 0; i < 200; ++i) driver.loop->schedule({i * kMs, 100 * kMs, push_right(0.01 * i)});
  driver.play(0);
  for (int i = 1; i < 200; ++i) {
    const TickRecord record = driver.tick();
    ASSERT_EQ(record.frame_ns, i * kMs);
    ASSERT_EQ(record.found, Found::kExact) << "frame " << i;
    ASSERT_EQ(record.wanted.force_N.x(), 0.01 * i) << "frame " << i;
  }
}

TEST(HapticLoop, SaysWhenItsRingIsFull) {
  LoopDriver driver;
  int taken = 0;
  while (taken < 10'000 && driver.loop->schedule(frame(taken * kFrame, {}))) ++taken;
  EXPECT_EQ(taken, 256);
}

TEST(HapticLoop, CountsWhatIsNotFinite) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), kInf, -kInf}) {
    for (int part = 0; part < 6; ++part) {
      Wrench wrench{{1, 1, 1}, {0.01, 0.01, 0.01}};
      (part < 3 ? wrench.force_N : wrench.torque_Nm)[part % 3] = bad;
      LoopDriver driver;
      driver.open();
      driver.loop->schedule(frame(0, wrench));
      driver.play(0);
      for (int i = 0; i < 10; ++i) ASSERT_EQ(driver.tick().commanded.stacked().norm(), 0) << part;
      EXPECT_EQ(driver.counters().rejected_wrenches, 10u) << part;
    }
  }
}

TEST(HapticLoop, CountsTimesThatDoNotRise) {
  LoopDriver driver;
  driver.open();
  for (const int64_t time : {kFrame, kFrame, int64_t{0}}) {
    driver.loop->schedule(frame(time, push_right(1)));
  }
  driver.play(0);
  driver.tick();
  EXPECT_EQ(driver.counters().refused_wrenches, 2u);
}

/// A force and a torque at their largest, with limits that a program changes.
struct Limited : LoopDriver {
  Limited(double force_N, double torque_Nm, const Pose& pose = {}) {
    put_grip(*this, pose);
    open();
    set(force_N, torque_Nm);
    for (int i = 0; i < 50; ++i)
      loop->schedule(frame(i * kFrame, {{force_N, 0, 0}, {0, 0, torque_Nm}}));
    play(0);
    last = run(10 * kFrame);
    answered_ns = now_ns;
  }
  void set(double force_N, double torque_Nm) {
    limits.max_force_N = force_N;
    limits.max_torque_Nm = torque_Nm;
    loop->set_limits(limits);
  }
  /// One tick, in which nothing may change faster than the slew limits in the time since the last
  /// answer, neither in the command nor at the hand.
  void check(const std::string& where) {
    const TickRecord now = watch.tick(*loop, now_ns += kTick_ns);
    const double passed_s = 1e-9 * static_cast<double>(now_ns - answered_ns);
    if (now.acknowledged) answered_ns = now_ns;
    const Wrench commanded = now.commanded - last.commanded;
    const Wrench delivered = now.delivered - last.delivered;
    // The solver trades residual against tension, see CommandsWhatIsWanted.
    const double solver_N = 2 * std::sqrt(TensionProblem{}.epsilon) * range_N();
    const double force_N = limits.max_slew_N_s * passed_s,
                 torque_Nm = limits.max_slew_Nm_s * passed_s;
    EXPECT_LE(commanded.force_N.norm(), force_N + 1e-12) << where;
    EXPECT_LE(commanded.torque_Nm.norm(), torque_Nm + 1e-12) << where;
    EXPECT_LE(delivered.force_N.norm(), force_N + solver_N) << where;
    EXPECT_LE(delivered.torque_Nm.norm(), torque_Nm + solver_N) << where;
    last = now;
  }
  double range_N() const { return (profile.max_tension_N() - profile.min_tension_N()).norm(); }

  SafetyLimits limits;
  int64_t answered_ns = 0;
  TickRecord last;
  TickWatch watch;
};

TEST(HapticLoop, LoweredLimitIsApproachedAtTheSlewLimit) {
  Pose aside;  // where the strings at rest pull the grip back
  aside.position_m = {-0.02, 0.01, 0};
  for (const Pose& pose : {Pose{}, aside}) {
    for (const auto& [from_N, from_Nm, to_N, to_Nm] :
         {std::array{3.0, 0.05, 0.0, 0.0}, std::array{3.0, 0.0, 0.25, 0.1},
          std::array{0.5, 0.1, 0.5, 0.0}, std::array{7.0, 0.1, 1.0, 0.05}}) {
      Limited driver(from_N, from_Nm, pose);
      const std::string where = "from " + std::to_string(from_N) + " N, " +
                                std::to_string(from_Nm) + " N m, to " + std::to_string(to_N) +
                                " N, " + std::to_string(to_Nm) + " N m";
      ASSERT_GT(driver.last.commanded.stacked().norm(), 0.4) << where;
      driver.set(to_N, to_Nm);
      const double takes_s = std::max((from_N - to_N) / driver.limits.max_slew_N_s,
                                      (from_Nm - to_Nm) / driver.limits.max_slew_Nm_s);
      for (int i = 0; i < 1000 * takes_s; ++i) driver.check(where);
      // A tick for the rounding of the sum of the steps.
      driver.check(where);
      EXPECT_LE(driver.last.commanded.force_N.norm(), to_N * (1 + 1e-15)) << where;
      EXPECT_LE(driver.last.commanded.torque_Nm.norm(), to_Nm * (1 + 1e-15)) << where;
      EXPECT_EQ(driver.last.max_force_N, to_N) << where;
      EXPECT_EQ(driver.last.max_torque_Nm, to_Nm) << where;
    }
  }
}

// A pause takes no longer from more force, but the slew limit would.
TEST(HapticLoop, LimitsOfZeroAreAPause) {
  Limited driver(10, 0.1);
  ASSERT_EQ(driver.last.commanded.force_N.norm(), 10);
  driver.set(0, 0);
  EXPECT_EQ(driver.run(kRamp).commanded.stacked().norm(), 0);
}

// Otherwise, a program that sets the limit of a loop itself throws 50 g at 7 m/s.
TEST(HapticLoop, NoLimitThrowsAGripThatIsLetGo) {
  SafetyLimits limits;
  limits.max_force_N = 30;
  LoopDriver constructed(limits);
  const double most_N = released_force_N(constructed.profile.drive_lag_s);
  ASSERT_LT(most_N, limits.max_force_N);
  constructed.open();
  constructed.loop->schedule({0, INT64_MAX / 2, push_right(30)});
  constructed.play(0);
  const TickRecord last = constructed.run(150 * kMs);
  EXPECT_EQ(last.commanded.force_N.norm(), most_N);
  EXPECT_EQ(last.max_force_N, most_N);
  EXPECT_EQ(Limited(30, 0.05).last.commanded.force_N.norm(), most_N);
}

TEST(HapticLoop, ALimitIsNoSaw) {
  Limited driver(3, 0.05);
  for (int i = 0; i < 400; ++i) {
    const bool low = i / 7 % 2 == 0;
    driver.set(low ? 0.1 : 3, low ? 0 : 0.05);
    driver.check("tick " + std::to_string(i));
  }
}

TEST(HapticLoop, ALimitThatIsLoweredWhileTheDeviceDoesNotAnswer) {
  Limited driver(3, 0.05);
  driver.set(0, 0);
  for (int i = 0; i < 30; ++i) {
    driver.log().answer = i % 10 < 5 ? LinkFault::kTimeout : LinkFault::kNone;
    driver.check("tick " + std::to_string(i));
  }
  EXPECT_EQ(driver.last.commanded.stacked().norm(), 0);
}

// If an answer made up for one tick only, a pause would take 74 ms with half of them missing, and
// 224 ms with nine tenths that come 5 ms late.
TEST(HapticLoop, PauseLimitAndEndTakeNoLongerWhenAnswersAreMissingOrLate) {
  const double kEnds_s = std::max(SafetyLimits{}.ramp_s, HapticLoop::kRelease_s);
  for (const int64_t step_ns : {kTick_ns, 5 * kTick_ns}) {
    for (const int missing : {0, 1}) {
      for (int how = 0; how < 3; ++how) {
        Playing driver;
        driver.run(5 * kFrame);
        if (how == 0) driver.pause();
        if (how == 1) driver.loop->set_limits({0, 0});
        if (how == 2) driver.loop->begin_close();
        // Two ticks more: until the first answer after that time.
        const int64_t end_ns =
            driver.now_ns + static_cast<int64_t>(1e9 * kEnds_s) + (missing + 1) * step_ns;
        for (int i = 0; driver.now_ns < end_ns; ++i) {
          driver.log().answer = missing > 0 && i % 2 == 0 ? LinkFault::kTimeout : LinkFault::kNone;
          driver.tick(step_ns);
        }
        const StringVector tension_N = tensions_N(driver.log().last_volts, driver.profile);
        const StringVector rest_N =
            how == 2 ? StringVector(StringVector::Zero()) : driver.profile.min_tension_N();
        EXPECT_LE((tension_N - rest_N).cwiseAbs().maxCoeff(), 1e-9)
            << "ticks of " << step_ns << " ns, " << missing << " missing, how " << how;
      }
    }
  }
}

// The answers of this link come so late that the force of a grip that is let go acts for longer.
TEST(HapticLoop, ALinkThatAnswersLateGetsLessForce) {
  Limited driver(10, 0.05);
  ASSERT_EQ(driver.last.commanded.force_N.norm(), 10);
  for (int i = 0; i < 1000; ++i) {
    // Encoders that never count would be taken for dead ones.
    put_grip(driver, {{i % 200 < 100 ? 0 : 1e-4, 0, 0}, Eigen::Quaterniond::Identity()});
    driver.log().answer = i % 2 == 0 ? LinkFault::kTimeout : LinkFault::kNone;
    driver.last = driver.tick();
  }
  EXPECT_EQ(driver.counters().times_lost, 0u);
  EXPECT_NEAR(driver.last.commanded.force_N.norm(),
              released_force_N(driver.profile.drive_lag_s, kTick_s), 1e-3);
}

TEST(HapticLoop, ALimitThatIsLoweredDuringAPause) {
  Limited driver(3, 0.05);
  driver.pause();
  for (int i = 0; i < 41; ++i) {
    if (i == 15) driver.set(0.2, 0);
    driver.check("tick " + std::to_string(i));
  }
  EXPECT_EQ(driver.last.commanded.stacked().norm(), 0);
}

TEST(HapticLoop, RaisedLimitIsApproachedAtTheSlewLimit) {
  Playing driver;
  driver.run(5 * kFrame);
  SafetyLimits limits;
  limits.max_force_N = 0.25;
  driver.loop->set_limits(limits);
  driver.run(20 * kMs);
  limits.max_force_N = 3;
  limits.max_slew_N_s = 50;
  driver.loop->set_limits(limits);
  double last_N = 0.25;
  for (int i = 0; i < 15; ++i) {
    const double now_N = driver.tick().commanded.force_N.norm();
    EXPECT_NEAR(now_N - last_N, 0.05, 1e-12);
    last_N = now_N;
  }
  EXPECT_EQ(driver.tick().commanded.force_N.x(), 1);
}

TEST(HapticLoop, CountsLateTicksAndMissedDeadlines) {
  LoopDriver driver;
  driver.open();
  const int64_t t = driver.now_ns;
  driver.loop->tick(t + kMs, t + kMs + kMs / 2);
  EXPECT_EQ(driver.loop->snapshot().last.lateness_ns, kMs / 2);
  EXPECT_EQ(driver.counters().overruns, 0u);
  EXPECT_EQ(driver.counters().missed_deadlines, 0u);
  driver.loop->tick(t + 2 * kMs, t + 5 * kMs);
  EXPECT_EQ(driver.counters().overruns, 1u);
  driver.loop->tick(t + 6 * kMs, t + 6 * kMs);
  EXPECT_EQ(driver.counters().overruns, 1u);
  EXPECT_EQ(driver.counters().missed_deadlines, 3u);
}

// A frame is held for 100 ms at most. What follows the last one, or is before a seek, is no gap.
TEST(HapticLoop, CountsTicksForWhichNoFrameCameInTime) {
  LoopDriver driver;
  driver.open();
  driver.loop->schedule(frame(0, push_right(1)));
  driver.play(0);
  driver.run(400 * kMs);
  EXPECT_EQ(driver.counters().gap_ticks, 0u) << "it may be the end";
  driver.loop->schedule(frame(450 * kMs, push_right(1)));
  driver.run(100 * kMs);
  // The next one rises in the 40 ms before it.
  EXPECT_GE(driver.counters().gap_ticks, 450u - 100 - 40);
  EXPECT_LT(driver.counters().gap_ticks, 450u - 40);
  const uint64_t before = driver.counters().gap_ticks;
  driver.run(400 * kMs);
  driver.pause();
  driver.run(10 * kMs);
  driver.play(1000 * kMs);
  driver.loop->schedule(frame(1000 * kMs, push_right(1)));
  driver.run(50 * kMs);
  EXPECT_EQ(driver.counters().gap_ticks, before);
}

TEST(HapticLoop, StallDoesNotEndInAStep) {
  Playing driver;
  const double before_N = driver.run(4 * kMs).commanded.force_N.x();
  // Long enough for the ramp to have come to its end, not so long that the pose is out of date.
  const double after_N = driver.tick(45 * kMs).commanded.force_N.x();
  EXPECT_GT(after_N, before_N);
  const double ramp_step =
      StaleRamp::kSteepest * 1e-9 * HapticLoop::kMaxStep_ns / SafetyLimits{}.ramp_s;
  EXPECT_LE(after_N - before_N, ramp_step * 1.0 + 1e-12);
}

}  // namespace
}  // namespace spidar::test::haptic_loop_test
