// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Conditions that hold in every tick whatever happens; and a tick does not allocate.
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/spidar/loop_driver.h"
#include "tests/support/allocation_count.h"

namespace spidar::test::haptic_loop_random_test {
namespace {

constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();

/// A player, a user and a device with random behaviour.
class Chaos {
 public:
  Chaos(LoopDriver& driver, uint64_t seed) : driver_(driver), random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool chance(double p) { return uniform(0, 1) < p; }

  Wrench wrench() {
    const double size = std::pow(10, uniform(-3, 3));
    Wrench w;
    for (int i = 0; i < 3; ++i) {
      w.force_N[i] = uniform(-size, size);
      w.torque_Nm[i] = uniform(-size, size) / 30;
    }
    if (chance(0.02)) w.force_N[1] = std::numeric_limits<double>::quiet_NaN();
    if (chance(0.02)) w.torque_Nm[2] = std::numeric_limits<double>::infinity();
    return w;
  }

  void act() {
    if (chance(0.05)) driver_.loop->schedule({running() + step(100), step(60), wrench()});
    if (chance(0.002)) driver_.loop->cancel_scheduled();
    if (chance(0.005)) play(chance(0.7));
    if (chance(0.005)) {
      limits.max_force_N = uniform(0, 6);
      limits.max_slew_N_s = uniform(10, 1000);
      driver_.loop->set_limits(limits);
    }
    if (chance(0.01)) move();
    if (chance(0.02)) driver_.log().answer = answer();
    if (driver_.loop->lost() && chance(0.01)) {
      driver_.log().answer = ExchangeStatus::kOk;
      driver_.loop->reopen();
    }
  }

  int64_t time_to_next_tick() { return chance(0.05) ? step(20) : kTick_ns; }

  SafetyLimits limits;

 private:
  int64_t step(double most_ms) { return static_cast<int64_t>(uniform(0, most_ms * kMs)); }
  int64_t running() const { return driver_.now_ns - offset_ns_; }
  void play(bool playing) {
    if (chance(0.2)) offset_ns_ = driver_.now_ns - step(1000);
    driver_.loop->set_playback_clock({driver_.now_ns, running(), 1.0, playing});
  }
  ExchangeStatus answer() {
    if (chance(0.03)) return ExchangeStatus::kLost;
    if (chance(0.1)) return ExchangeStatus::kTimeout;
    if (chance(0.1)) return ExchangeStatus::kBadReply;
    return ExchangeStatus::kOk;
  }
  /// The grip jumps to any place that a hand can reach; sometimes an encoder gives nonsense.
  void move() {
    const StringGeometry& geometry = driver_.profile.geometry;
    const Pose pose{{uniform(-0.02, 0.02), uniform(-0.02, 0.02), uniform(-0.02, 0.02)}, {}};
    const StringVector change =
        string_lengths_m(geometry, {pose.position_m, Eigen::Quaterniond::Identity()}) -
        string_lengths_m(geometry, {});
    for (int i = 0; i < geometry.count; ++i) {
      const auto k = static_cast<size_t>(i);
      const StringDrive& drive = driver_.profile.drives[k];
      driver_.log().count[k] =
          drive.encoder_sign *
          static_cast<int32_t>(std::lround(change[i] / drive.metres_per_count));
    }
    if (chance(0.1)) driver_.log().count[3] += 1'000'000;
  }

  LoopDriver& driver_;
  std::mt19937_64 random_;
  int64_t offset_ns_ = 0;
};

/// `taut`: no string is out, nor has been until shortly before.
void check_strings(const TickRecord& record, const Profile& profile, bool taut) {
  const StringVector least = profile.min_tension_N();
  const StringVector most = profile.max_tension_N();
  ASSERT_TRUE(record.tension_N.allFinite());
  ASSERT_TRUE(record.delivered.is_finite());
  for (int i = 0; i < profile.geometry.count; ++i) {
    ASSERT_GE(record.tension_N[i], taut ? least[i] : 0);
    ASSERT_LE(record.tension_N[i], most[i]);
  }
}

void check_volts(const MotorVolts& volts, const Profile& profile) {
  for (int i = 0; i < profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const double pulling_V = volts.volt[k] * profile.drives[k].motor_sign;
    ASSERT_GE(pulling_V, 0);
    ASSERT_LE(pulling_V, profile.dac_max_V);
  }
}

void run_chaos(uint64_t seed, int ticks) {
  LoopDriver driver;
  driver.loop->open();
  Chaos chaos(driver, seed);
  double largest_N = chaos.limits.max_force_N;
  Wrench last;
  int taut_ticks = 0;
  for (int i = 0; i < ticks; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", tick " + std::to_string(i));
    chaos.act();
    const int64_t step_ns = chaos.time_to_next_tick();
    const bool was_lost = driver.loop->lost();
    const TickRecord record = driver.tick(step_ns);
    const SafetyLimits& limits = chaos.limits;
    largest_N = std::max(largest_N, limits.max_force_N);

    ASSERT_TRUE(record.commanded.is_finite());
    ASSERT_LE(record.commanded.force_N.norm(), limits.max_force_N * (1 + kRounding));
    ASSERT_LE(record.commanded.torque_Nm.norm(), limits.max_torque_Nm * (1 + kRounding));
    // A string that was out takes at most 20 ms back to its least tension, and so do those that
    // wait for it; a device that comes up is not taut either.
    const bool out = record.faulty_string >= 0 || record.device != DeviceState::kRunning;
    taut_ticks = out ? 0 : taut_ticks + 1;
    check_strings(record, driver.profile, taut_ticks > 50);
    check_volts(driver.log().last_volts, driver.profile);

    // Rates, see WrenchSafety. A lowered limit may cut off the rest, a lost device drops it.
    const double dt_s = 1e-9 * static_cast<double>(std::min(step_ns, HapticLoop::kMaxStep_ns));
    const double rate_N_s =
        std::max(limits.max_slew_N_s, StaleRamp::kSteepest * largest_N / limits.ramp_s);
    const double cut_off_N = std::max(0.0, last.force_N.norm() - limits.max_force_N);
    if (!was_lost && record.device != DeviceState::kLost) {
      ASSERT_LE((record.commanded.force_N - last.force_N).norm(),
                rate_N_s * dt_s + cut_off_N + 1e-12);
    }
    last = record.device == DeviceState::kLost ? Wrench{} : record.commanded;
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(driver.counters().rejected_wrenches, 0u);
  EXPECT_GT(driver.counters().times_lost, 0u);
  EXPECT_GT(driver.counters().pose_errors, 0u);
}

TEST(HapticLoopRandom, HoldsItsLimitsWhateverHappens) {
  for (const uint64_t seed : {1u, 2u, 3u, 4u}) {
    run_chaos(seed, 25'000);
    if (HasFatalFailure()) return;
  }
}

TEST(HapticLoopRandom, TickDoesNotAllocate) {
  LoopDriver driver;
  driver.loop->open();
  Chaos chaos(driver, 99);
  TickRecord record;
  for (int i = 0; i < 5000; ++i) {
    chaos.act();
    driver.now_ns += chaos.time_to_next_tick();
    const long before = allocations;
    driver.loop->tick(driver.now_ns, driver.now_ns);
    driver.loop->pop_record(record);
    ASSERT_EQ(allocations, before) << "tick " << i;
  }
}

TEST(HapticLoopRandom, AllocationsAreCounted) {
  const long before = allocations;
  void* volatile memory = std::malloc(1);  // not left out by the compiler
  EXPECT_EQ(allocations, before + (kCountsAllocations ? 1 : 0));
  std::free(memory);
}

}  // namespace
}  // namespace spidar::test::haptic_loop_random_test
