// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The lag of a simulated device's drives, measured through the loop, the D/A and the encoders.
#include "spidar/link/link_thread.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/stiffness_limit.h"
#include "spidar/selftest/delay_test.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "tests/spidar/kinds.h"
#include "tests/support/messages.h"
#include "tests/support/tampered_device.h"
#include "tests/support/test.h"

namespace spidar::test::delay_test {
namespace {

GripModel light_hand() {
  GripModel model;
  model.hand_stiffness_N_m = 100;
  model.hand_damping_N_s_m = 2;
  return model;
}

/// What the steps of the simulation make of its lag. In a step of h the tension is that at its end,
/// so that after a step of the command the tensions are missing h e^(−h/T) + h e^(−2h/T) + … of it
/// = h / (e^(h/T) − 1), and the grip goes on at the speed that it has at the end, which is h/2
/// early.
double true_lag_s(const Profile& profile, const GripModel& model) {
  const GripDynamics dynamics(profile.geometry, profile.max_tension_N(), model);
  const double tick_s = 1e-9 * kTick_ns;
  const double step_s = tick_s / std::ceil(tick_s / dynamics.max_step_s());
  const double part_s = model.motor_time_constant_s;
  const double first_order_s = part_s > 0 ? step_s / std::expm1(step_s / part_s) : 0;
  return model.motor_delay_s + first_order_s - step_s / 2;
}

/// Time that goes on by a tick whenever the loop waits.
struct StoppedTime {
  int64_t now_ns = 0;
  int64_t end_ns = INT64_MAX;  // interrupted then

  std::function<int64_t()> clock() {
    return [this] { return now_ns; };
  }
  selftest::Pace pace() {
    return [this] {
      now_ns += kTick_ns;
      return now_ns < end_ns;
    };
  }
};

selftest::DelayTest measure(const std::string& board, const Profile& profile,
                            const GripModel& model, uint32_t seed) {
  StoppedTime time;
  std::unique_ptr<StringDevice> device;
  if (board == "sim") {
    device = std::make_unique<SimulatedDevice>(profile, SimulatedDevice::Time::kClock, model,
                                               time.clock());
  } else {
    boards::AnyBoard simulated =
        simulated_board(kind_of(board.substr(4)), board, profile, {model, time.clock()});
    device = std::make_unique<boards::StringLink>(
        std::get<std::unique_ptr<boards::Board>>(std::move(simulated)), settings_of_simulation());
  }
  selftest::DelaySettings settings;
  settings.seed = seed;
  return selftest::measure_delay(*device, profile, time.pace(), time.clock(), settings);
}

/// The interval is 99.7 % wide, and the seeds are given: the true lag is in each, or something is
/// wrong. LagFitter bounds how wide it may be.
void expect_right(const selftest::DelayTest& test, const Profile& profile, const GripModel& model) {
  ASSERT_TRUE(test.measured()) << test.error;
  const double lag_s = true_lag_s(profile, model);
  EXPECT_LE(test.fit->least_s, lag_s);
  EXPECT_GE(test.fit->most_s, lag_s);
  EXPECT_EQ(test.periods, selftest::DelaySettings().periods);
}

TEST(Delay, OfTheSimulatedDeviceIsFound) {
  const Profile profile = load_profile(kDefaultProfile);
  for (const int lag_ms : {0, 1, 2, 5, 10}) {
    for (uint32_t seed = 1; seed <= 2; ++seed) {
      SCOPED_TRACE(testing::Message() << lag_ms << " ms, seed " << seed);
      GripModel model = light_hand();
      model.motor_time_constant_s = 1e-3 * lag_ms;
      expect_right(measure("sim", profile, model, seed), profile, model);
      std::swap(model.motor_time_constant_s, model.motor_delay_s);
      const selftest::DelayTest delayed = measure("sim", profile, model, seed);
      expect_right(delayed, profile, model);
      // Nothing but a delay: its phase is told best.
      EXPECT_LT(delayed.fit->error_s, 50e-6);
    }
  }
}

// A finger tip, a light grasp and a firm one.
TEST(Delay, OfTheDriveIsNotThatOfTheHand) {
  const Profile profile = load_profile(kDefaultProfile);
  const double hands[][2] = {{30, 0.5}, {100, 2}, {300, 8}};
  for (const auto& [stiffness_N_m, damping_N_s_m] : hands) {
    SCOPED_TRACE(stiffness_N_m);
    GripModel model;
    model.hand_stiffness_N_m = stiffness_N_m;
    model.hand_damping_N_s_m = damping_N_s_m;
    expect_right(measure("sim", profile, model, 3), profile, model);
  }
}

TEST(Delay, OfEmulatedBoardsIsFound) {
  for (const std::string& name : boards_that_there_are(true)) {
    const std::string board = "sim:" + name;
    const Profile profile = load_profile(board_info(board).profile);
    for (const int lag_ms : {0, 1, 2, 5, 10}) {
      SCOPED_TRACE(testing::Message() << board << " " << profile.name << " " << lag_ms << " ms");
      GripModel model = light_hand();
      model.motor_time_constant_s = 5e-4 * lag_ms;
      model.motor_delay_s = 5e-4 * lag_ms;
      expect_right(measure(board, profile, model, 4), profile, model);
    }
  }
}

// It trembles by 0.2 mm at 9 Hz and drifts by 1 mm, ten times what the force moves the grip at 40
// Hz.
TEST(Delay, WithAHandThatTremblesIsFound) {
  const Profile profile = load_profile(kDefaultProfile);
  StoppedTime time;
  const GripModel model = light_hand();
  SimulatedDevice device(profile, SimulatedDevice::Time::kClock, model, time.clock());
  const selftest::Pace pace = [&, tick = time.pace()] {
    const double t = 1e-9 * static_cast<double>(time.now_ns);
    Pose hand;
    hand.position_m.x() = 1e-3 * std::sin(2 * M_PI * 0.31 * t);
    hand.position_m.z() =
        1e-3 * std::sin(2 * M_PI * 0.43 * t) + 2e-4 * std::sin(2 * M_PI * 9.3 * t);
    device.set_hand(hand);
    return tick();
  };
  expect_right(selftest::measure_delay(device, profile, pace, time.clock()), profile, model);
}

TEST(Delay, GivesNoNumberWhenTheGripCannotMove) {
  const Profile profile = load_profile(kDefaultProfile);
  for (const double stiffness_N_m : {5e4, 1e6}) {
    SCOPED_TRACE(stiffness_N_m);
    GripModel clamped;
    clamped.hand_stiffness_N_m = stiffness_N_m;
    clamped.hand_damping_N_s_m = 20;
    const selftest::DelayTest test = measure("sim", profile, clamped, 1);
    EXPECT_FALSE(test.measured());
    EXPECT_TRUE(test.complete);
    EXPECT_FALSE(test.is_of_device);
    expect_contains(test.error, "hold it loosely, so that it can move");
  }
}

/// What the strings do, from outside.
struct Watched {
  Profile profile = load_profile(kDefaultProfile);
  StoppedTime time;
  SimulatedDevice sim{profile, SimulatedDevice::Time::kClock, light_hand(), time.clock()};
  TamperedDevice device{sim};
  double largest_N = 0;
  double last_V = 0;

  /// `happen` at this time.
  selftest::DelayTest measure(double at_s, const std::function<void()>& happen) {
    const selftest::Pace pace = [&, tick = time.pace()] {
      if (time.now_ns == std::llround(1e3 * at_s) * kTick_ns) happen();
      largest_N = std::max(largest_N, sim.felt().wrench.force_N.norm());
      last_V = 0;
      for (const double volt : device.volts().volt) last_V = std::max(last_V, std::abs(volt));
      return tick();
    };
    return selftest::measure_delay(device, profile, pace, time.clock());
  }
};

// Above the force that was announced there is only what the D/A's steps add: half a step for each
// string.
TEST(Delay, PushesNoHarderThanItSays) {
  Watched watched;
  const selftest::DelayTest test = watched.measure(1, [] {});
  EXPECT_TRUE(test.measured()) << test.error;
  const double peak_N = selftest::DelaySettings().peak_N;
  EXPECT_GT(watched.largest_N, 0.9 * peak_N);
  const double step_N = watched.profile.dac_max_V / ((1 << watched.profile.dac_bits) - 1) *
                        watched.profile.drives[0].newtons_per_volt;
  EXPECT_LE(watched.largest_N, peak_N + 8 * step_N / 2 + 0.06);  // and 0.06 N at rest (safety.md)
  EXPECT_NEAR(1e-9 * static_cast<double>(watched.time.now_ns), selftest::DelaySettings().seconds(),
              0.5);
}

TEST(Delay, StopsAtAnyFault) {
  struct Fault {
    const char* says;
    std::function<void(Watched&)> happen;
  };
  const Fault faults[] = {
      {"does not answer", [](Watched& w) { w.sim.set_fault(LinkFault::kGone); }},
      {"does not answer", [](Watched& w) { w.sim.set_fault(LinkFault::kTimeout); }},
      {"string 3", [](Watched& w) { w.sim.set_count_error(3, 400); }},
      {"pose of the grip was lost",
       [](Watched& w) {
         for (int i = 0; i < 3; ++i) w.sim.set_count_error(i, 4000);
       }},
      {"further than 20 mm",
       [](Watched& w) {
         Pose away;
         away.position_m.x() = 0.03;
         w.sim.set_hand(away);
       }},
  };
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.says);
    Watched watched;
    const selftest::DelayTest test = watched.measure(3, [&] { fault.happen(watched); });
    EXPECT_FALSE(test.measured());
    expect_contains(test.error, fault.says);
    EXPECT_LT(watched.time.now_ns, 4000 * kTick_ns);
    EXPECT_EQ(watched.sim.felt().tension_N.norm(), 0);
    EXPECT_EQ(test.is_of_device,
              std::string(fault.says) != "further than 20 mm");  // the hand's own
  }
}

TEST(Delay, InterruptedReleasesTheStrings) {
  Watched watched;
  watched.time.end_ns = 2000 * kTick_ns;
  const selftest::DelayTest test = watched.measure(1, [] {});
  EXPECT_FALSE(test.complete);
  EXPECT_FALSE(test.measured());
  // The ramp to zero, 50 ms.
  EXPECT_NEAR(static_cast<double>(watched.time.now_ns), 2050e6, 5e6);
  EXPECT_EQ(watched.sim.felt().tension_N.norm(), 0);
}

// The machine has no time for the loop: 15 ms, and 90 ms, after which the pose is not known for a
// while and the force rests.
TEST(Delay, SecondsWithAPauseAreTriedAgain) {
  for (const int pause_ms : {15, 90}) {
    SCOPED_TRACE(pause_ms);
    Watched watched;
    const selftest::DelayTest test =
        watched.measure(3, [&] { watched.time.now_ns += pause_ms * kTick_ns; });
    expect_right(test, watched.profile, light_hand());
    const double took_s = 1e-9 * static_cast<double>(watched.time.now_ns);
    EXPECT_NEAR(took_s, selftest::DelaySettings().seconds() + selftest::DelaySettings::kRound_s,
                0.5);
  }
}

// A machine that is too busy all the time.
TEST(Delay, TooFewSecondsGiveNoNumber) {
  Watched watched;
  const selftest::Pace pace = [&, tick = watched.time.pace()] {
    if (watched.time.now_ns % (700 * kTick_ns) == 0) watched.time.now_ns += 20 * kTick_ns;
    return tick();
  };
  const selftest::DelayTest test =
      selftest::measure_delay(watched.sim, watched.profile, pace, watched.time.clock());
  EXPECT_FALSE(test.measured());
  expect_contains(test.error, "only 0 of 18 seconds");
}

TEST(LagVerdict, SaysWhetherTheProfileIsRight) {
  selftest::LagFit fit;
  fit.least_s = 0.0018;
  fit.lag_s = 0.0020;
  fit.most_s = 0.00223;
  Profile profile;
  constexpr int64_t kInTime_ns = 700'000;
  for (const auto& [stated_s, enough] :
       {std::pair{0.0017, false}, std::pair{0.0018, true}, std::pair{0.0023, true}}) {
    profile.drive_lag_s = stated_s;
    EXPECT_EQ(selftest::judge_lag(profile, fit, kInTime_ns).stated_enough, enough) << stated_s;
  }
  EXPECT_NEAR(selftest::judge_lag(profile, fit, 0).safe_lag_s, 0.0023, 1e-12);
  EXPECT_NEAR(selftest::judge_lag(profile, fit, kInTime_ns).safe_lag_s, 0.0023, 1e-12);
  // Answers that the loop does not wait for count a tick later, or two.
  EXPECT_NEAR(selftest::judge_lag(profile, fit, kInTime_ns + 1).safe_lag_s, 0.0033, 1e-12);
  EXPECT_FALSE(selftest::judge_lag(profile, fit, kInTime_ns + 1).stated_enough);
  EXPECT_NEAR(selftest::judge_lag(profile, fit, 2'000'000).safe_lag_s, 0.0043, 1e-12);
  // A lag below zero is none: what acts before it is told is not to be had.
  fit.least_s = -0.0004;
  fit.most_s = -0.0001;
  profile.drive_lag_s = 0;
  EXPECT_TRUE(selftest::judge_lag(profile, fit, 0).stated_enough);
  EXPECT_EQ(selftest::judge_lag(profile, fit, 0).safe_lag_s, 0);
}

TEST(StiffnessLimit, IsThatOfTheDelay) {
  EXPECT_DOUBLE_EQ(surface_delay_s(0.002), 0.0035);
  EXPECT_DOUBLE_EQ(most_stiffness_N_m(0), 800);
  EXPECT_DOUBLE_EQ(most_stiffness_N_m(0.0055), 400);
}

}  // namespace
}  // namespace spidar::test::delay_test
