// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Random wrenches, hands and faults on every profile, checked at the output to the device, and no
/// tick takes anything from the heap. Short
/// by default; SPIDAR_TICKS=10000000 is the long run (--suite soak), SPIDAR_SEED selects another
/// seed, SPIDAR_ROUND the first round of it.
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/string_grip.h"
#include "tests/support/allocation_count.h"
#include "tests/support/late_ticks.h"
#include "tests/support/random_motion.h"
#include "tests/support/seam_watch.h"
#include "tests/support/tampered_device.h"
#include "tests/support/test.h"

namespace spidar::test::random_safety_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kFrame_ns = 40 * kMs;
constexpr int64_t kRest_ns = 50 * kMs;
/// Counted from the moment at which the last frame is shown.
constexpr int64_t kExpiry_ns = 100 * kMs;
/// For the short run: two rounds on each profile.
constexpr int kRoundTicks = 2000;

uint64_t number(const char* variable, uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// One device with one zero, from opening to closing.
class Round {
 public:
  /// `limits_change`: during play and rest, to nothing too.
  Round(const std::string& profile, uint64_t seed, bool limits_change)
      : random_(seed),
        random_limits_(seed + 1),
        limits_change_(limits_change),
        believed_(load_profile(profile)),
        zero_(random_.chance(0.5) ? Pose{} : random_.pose(0.005, 3 * M_PI / 180)),
        real_(zeroed_at(believed_, zero_)),
        where_(profile + ", round with seed " + std::to_string(seed)),
        watch_(real_),
        simulated_(real_, SimulatedDevice::Time::kClock, {}, [this] { return exchanged_ns_; }),
        device_(simulated_),
        ticks_(seed, kTick_ns) {
    limits_.max_force_N = random_.uniform(0.2, 6);
    limits_.max_torque_Nm = random_.uniform(0.01, 0.2);
    loop_ = std::make_unique<HapticLoop>(std::make_unique<StringGrip>(believed_, device_), limits_);
    size_N_ =
        std::hypot(limits_.max_force_N, limits_.max_torque_Nm / believed_.geometry.grip_radius_m());
    loop_->open();
  }

  /// Returns false when a condition was violated.
  bool run(int ticks) {
    for (int i = 0; i < ticks && !watch_.failed(); ++i) {
      act();
      tick();
    }
    close();
    return !watch_.failed();
  }

  const SeamWatch::Largest& largest() const { return watch_.largest(); }

 private:
  Wrench wrench() {
    const double size = std::pow(10, random_.uniform(-3, 3));
    Wrench w{size * random_.direction(), 0.03 * size * random_.direction()};
    if (random_.chance(0.02)) w.force_N[random_.some(3)] = std::numeric_limits<double>::quiet_NaN();
    if (random_.chance(0.02))
      w.torque_Nm[random_.some(3)] = std::numeric_limits<double>::infinity();
    return w;
  }

  int64_t running_ns() const { return now_ns_ - played_at_ns_; }

  /// From now on there must be no force.
  void stop(int64_t rest_in_ns) {
    if (!playing_) return;
    playing_ = false;
    rest_in_ns_ = rest_in_ns;
    unanswered_ns_ = 0;
    watch_.stop();
  }

  void play() {
    loop_->cancel_scheduled();
    played_at_ns_ = now_ns_;
    next_frame_ns_ = 0;
    loop_->set_playback_clock({now_ns_, 0, 1, true});
    playing_ = true;
  }

  void act() {
    if (playing_ && running_ns() >= next_frame_ns_ - kFrame_ns) {
      loop_->schedule({next_frame_ns_, kFrame_ns, wrench()});
      next_frame_ns_ += kFrame_ns;
    }
    if (!playing_ && rest_in_ns_ < -100 * kMs && random_.chance(0.01)) play();
    if (playing_ && random_.chance(0.002)) stop_somehow();
    if (limits_change_ && random_limits_.chance(0.005)) {
      SafetyLimits limits = limits_;
      const double left = random_limits_.chance(0.3) ? 0 : random_limits_.uniform(0, 1);
      limits.max_force_N *= left;
      limits.max_torque_Nm *= left;
      loop_->set_limits(limits);
    }
    if (random_.chance(0.005))
      simulated_.set_hand(random_.chance(0.8) ? random_.pose(0.02, M_PI / 3)
                                              : random_.pose(0.06, 1.4));
    if (random_.chance(0.001))
      device_.stop_encoders(random_.chance(0.5) ? 0 : static_cast<unsigned>(random_.some(256)));
    if (random_.chance(0.001)) {
      const int string = random_.some(real_.geometry.count);
      simulated_.set_count_error(string, random_.chance(0.5) ? 0 : random_.some(2000) - 1000);
      miscounts_ = true;
    }
    if (fault_ticks_ > 0 && --fault_ticks_ == 0) simulated_.set_fault(LinkFault::kNone);
    if (fault_ticks_ == 0 && random_.chance(0.002)) {
      fault_ticks_ = 1 + random_.some(25);
      simulated_.set_fault(random_.chance(0.05)  ? LinkFault::kGone
                           : random_.chance(0.5) ? LinkFault::kTimeout
                                                 : LinkFault::kWrongReply);
    }
    if (loop_->lost() && fault_ticks_ == 0 && random_.chance(0.05)) {
      watch_.reset();
      loop_->reopen();
    }
  }

  /// Every way in which a player ends a force.
  void stop_somehow() {
    switch (random_.some(4)) {
      case 0:  // pause
        loop_->set_playback_clock({now_ns_, running_ns(), 1, false});
        return stop(kRest_ns);
      case 1:  // flush, and nothing new
        loop_->cancel_scheduled();
        return stop(kRest_ns);
      case 2:  // an invalid clock
        loop_->set_playback_clock({now_ns_, 0, std::numeric_limits<double>::quiet_NaN(), true});
        return stop(kRest_ns);
      default:  // no more frames: the last one is still ahead
        return stop(next_frame_ns_ - kFrame_ns - running_ns() + kExpiry_ns);
    }
  }

  /// The device is read while the tick runs.
  void tick() {
    ticks_.advance();
    const int64_t passed_ns = ticks_.now_ns() - now_ns_;
    now_ns_ = ticks_.now_ns();
    exchanged_ns_ = now_ns_ + std::llround(random_.uniform(0, 1) * LateTicks::kCycle_ns);
    const Wrench at_rest = loop_->grip().reading().at_rest;
    const long before = allocations;
    loop_->tick(ticks_.deadline_ns(), now_ns_);
    EXPECT_EQ(allocations, before) << where_ << ": a tick allocates";
    SeamWatch::Tick seen;
    seen.acknowledged = device_.status() == LinkFault::kNone && !loop_->lost();
    // A device that does not answer keeps what it was told.
    unanswered_ns_ += passed_ns;
    if (seen.acknowledged) rest_in_ns_ -= std::exchange(unanswered_ns_, 0);
    seen.told_N = tensions_N(device_.volts(), real_);
    seen.dt_s = 1e-9 * static_cast<double>(passed_ns);
    seen.brakes = loop_->snapshot().last.brakes;
    // Whatever the limits are, the damper may take back what the strings at rest give; what it
    // leaves falls as fast as tensions do.
    if (seen.brakes) {
      damped_ns_ = std::llround(1e9 * TensionSlew::kRange_s) + kMs;
      damper_N_ =
          std::max(damper_N_, std::hypot(std::max(limits_.max_force_N, at_rest.force_N.norm()),
                                         std::max(limits_.max_torque_Nm, at_rest.torque_Nm.norm()) /
                                             believed_.geometry.grip_radius_m()));
    } else if (seen.acknowledged && (damped_ns_ -= passed_ns) < 0) {
      damper_N_ = 0;
    }
    seen.size_N = std::max(size_N_, damper_N_);
    seen.sees = !device_.is_tampered() && !miscounts_;
    // What a damper leaves falls as fast as tensions do.
    if (seen.brakes) {
      rest_in_ns_ = std::max<int64_t>(rest_in_ns_, std::lround(1e9 * TensionSlew::kRange_s));
    }
    seen.resting = !playing_ && rest_in_ns_ < 0;
    seen.felt = simulated_.felt();
    watch_.check(seen, where_ + ", at " + std::to_string(now_ns_ / kMs) + " ms");
  }

  /// Off within 100 ms of time in which the device answers.
  void close() {
    stop(kRest_ns);
    simulated_.set_fault(LinkFault::kNone);
    loop_->begin_close();
    int ticks = 0;
    while (!loop_->released()) {
      tick();
      ASSERT_LE(++ticks, 100) << where_;
    }
    loop_->close();
    SeamWatch::Tick off;
    off.told_N = tensions_N(device_.volts(), real_);
    off.released = off.resting = true;
    off.felt = simulated_.felt();
    watch_.check(off, where_ + ", closed");
  }

  RandomMotion random_, random_limits_;
  const bool limits_change_;
  const Profile believed_;
  const Pose zero_;
  const Profile real_;
  const std::string where_;
  SeamWatch watch_;
  SimulatedDevice simulated_;
  TamperedDevice device_;
  SafetyLimits limits_;
  std::unique_ptr<HapticLoop> loop_;
  double size_N_ = 0;
  LateTicks ticks_;
  bool miscounts_ = false;  ///< a counter was wrong at some time
  int64_t now_ns_ = 0;
  int64_t exchanged_ns_ = 0;
  int64_t played_at_ns_ = 0;
  int64_t next_frame_ns_ = 0;
  bool playing_ = false;
  int64_t rest_in_ns_ = 0;
  int64_t unanswered_ns_ = 0;
  int64_t damped_ns_ = 0;  ///< for how long the damper still acts
  double damper_N_ = 0;    ///< the largest wrench of it
  int fault_ticks_ = 0;
};

TEST(RandomSafety, AllocationsAreCounted) {
  const long before = allocations;
  void* volatile memory = std::malloc(1);  // not left out by the compiler
  EXPECT_EQ(allocations, before + (kCountsAllocations ? 1 : 0));
  std::free(memory);
}

TEST(RandomSafety, HoldsWhateverHappens) {
  const uint64_t seed = number("SPIDAR_SEED", 1);
  const uint64_t ticks = number("SPIDAR_TICKS", 96'000);
  const std::vector<std::string> names = list_profiles();
  SeamWatch::Largest all;
  uint64_t done = 0;
  const uint64_t first = number("SPIDAR_ROUND", 0);
  for (uint64_t n = first; done < ticks; ++n, done += kRoundTicks) {
    Round round(names[n % names.size()], seed * 1'000'003 + n, n % 2 == 1);
    if (!round.run(kRoundTicks)) {
      FAIL() << "SPIDAR_SEED=" << seed << " SPIDAR_ROUND=" << n << " plays it again";
    }
    const SeamWatch::Largest& one = round.largest();
    all.resting_force_N = std::max(all.resting_force_N, one.resting_force_N);
    all.resting_excess = std::max(all.resting_excess, one.resting_excess);
    all.playing_force_N = std::max(all.playing_force_N, one.playing_force_N);
    all.step_N = std::max(all.step_N, one.step_N);
    all.stop_energy_J = std::max(all.stop_energy_J, one.stop_energy_J);
    all.resting_ticks += one.resting_ticks;
    all.playing_ticks += one.playing_ticks;
  }
  EXPECT_GT(all.resting_ticks, done / 10);
  EXPECT_GT(all.playing_ticks, done / 10);
  std::printf(
      "%llu ticks, seed %llu: at rest %.3f N on the real grip, %.1e N above that of the least "
      "tensions; playing %.2f N; a string by %.3f N in a tick; %.4f J from a stop to rest\n",
      static_cast<unsigned long long>(done), static_cast<unsigned long long>(seed),
      all.resting_force_N, all.resting_excess, all.playing_force_N, all.step_N, all.stop_energy_J);
}

// Its strings were behind what was commanded, and the brake, which lets a string change at once,
// let them catch up: by 1.6 W in a tick.
TEST(RandomSafety, ABrakeLetsNoStringPushAtOnce) {
  EXPECT_TRUE(Round("spidar-g-sh", 20'261'188'783'601, false).run(kRoundTicks));
}

// The pose was lost in a tick that was 3 ms late, while a string still rose: it rose by 3 ms more.
TEST(RandomSafety, AStringThatRisesStopsWithThePose) {
  EXPECT_TRUE(Round("spidar-g-sh", 101'000'448, true).run(kRoundTicks));
}

// One string counted as faulty, and then another instead: the pose went by 4 mm and 20° in a tick,
// and the damper took that for a grip that flies.
TEST(RandomSafety, APoseFromOtherStringsIsNoMotion) {
  EXPECT_TRUE(Round("spidar-g6x5-r", 1'000'353, false).run(kRoundTicks));
}

}  // namespace
}  // namespace spidar::test::random_safety_test
