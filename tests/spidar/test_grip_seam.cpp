// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What protects the hand holds for every grip: the loop on one without strings, which protects
/// nobody.
#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "spidar/loop/haptic_loop.h"
#include "tests/support/fake_grip.h"
#include "tests/support/random_motion.h"
#include "tests/support/tick_watch.h"

namespace spidar::test::grip_seam_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kFrame_ns = 40 * kMs;
constexpr int64_t kHour_ns = 3'600'000 * kMs;

class GripSeam : public testing::Test {
 protected:
  explicit GripSeam(bool can_fly = false) {
    auto made = std::make_unique<FakeGrip>(can_fly);
    made->commands.reserve(100'000);
    grip = made.get();
    loop = std::make_unique<HapticLoop>(std::move(made));
    loop->open();
  }

  void tick(int count = 1) {
    for (int i = 0; i < count; ++i) {
      now_ns += kTick_ns;
      loop->tick(now_ns, now_ns);
    }
  }
  const GripCommand& told() const { return grip->commands.back(); }
  double told_N() const { return told().wrench.force_N.norm(); }

  /// A film of a single force begins.
  void play(const Eigen::Vector3d& force_N) {
    loop->cancel_scheduled();
    loop->set_playback_clock({now_ns, 0, 1.0, true});
    TimedWrench entry;
    entry.hold_ns = kHour_ns;
    entry.wrench.force_N = force_N;
    ASSERT_TRUE(loop->schedule(entry));
  }
  /// Until everything is switched on, and this force is exerted.
  void push(const Eigen::Vector3d& force_N) {
    play(force_N);
    tick(static_cast<int>(1e3 * HapticLoop::kEnergise_s) + 1);
    ASSERT_EQ(told().wrench.force_N, force_N);
  }
  void pause() { loop->set_playback_clock({now_ns, 0, 1.0, false}); }

  FakeGrip* grip = nullptr;
  std::unique_ptr<HapticLoop> loop;
  int64_t now_ns = 7'000'000'000'000;
};

TEST_F(GripSeam, TheWrenchGoesOutAndThePoseComesBack) {
  grip->position_m = {0.01, -0.02, 0.03};
  push({1, -2, 0.5});
  EXPECT_EQ(told().power, 1);
  EXPECT_TRUE(told().fresh);
  const LoopSnapshot now = loop->snapshot();
  EXPECT_EQ(now.last.pose.position_m, grip->position_m);
  EXPECT_EQ(now.last.delivered.force_N, Eigen::Vector3d(1, -2, 0.5));
  EXPECT_TRUE(now.last.tension_N.isZero(0));
  EXPECT_EQ(now.pose_trouble, PoseTrouble::kNone);
}

TEST_F(GripSeam, NothingThatAFilmWantsReachesTheHandUnlimited) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  RandomMotion random(3);
  TickWatch watch;  // compares limits and rates in every tick
  loop->set_playback_clock({now_ns, 0, 1.0, true});
  const int64_t begin_ns = now_ns;
  int64_t next_ns = 0;
  for (int ms = 0; ms < 20'000; ++ms) {
    if (now_ns - begin_ns >= next_ns - kFrame_ns) {
      Wrench wanted{Eigen::Vector3d(random.uniform(-50, 50), random.uniform(-50, 50), 1e9),
                    Eigen::Vector3d(random.uniform(-5, 5), 0, 0)};
      if (random.chance(0.1)) wanted.force_N.y() = random.chance(0.5) ? kNan : kInfinity;
      loop->schedule({next_ns, kFrame_ns, wanted});
      next_ns += kFrame_ns;
    }
    now_ns += kTick_ns;
    watch.tick(*loop, now_ns);
    ASSERT_TRUE(told().wrench.is_finite());
    ASSERT_LE(told_N(), SafetyLimits{}.max_force_N * (1 + 1e-12));
  }
  EXPECT_GT(watch.felt(), 10'000u);
  EXPECT_GT(loop->snapshot().counters.rejected_wrenches, 0u);
}

TEST_F(GripSeam, APauseRestsWithinTheRampWithoutAKnownPose) {
  push({2, 0, 0});
  grip->known = false;
  pause();
  tick(41);  // 40 ms, and the tick in which the pause is seen
  EXPECT_EQ(told_N(), 0);
}

TEST_F(GripSeam, ThereIsNoForceWhereThePoseIsNotKnown) {
  grip->known = false;
  play({2, 0, 0});
  for (int ms = 0; ms < 500; ++ms) {
    tick();
    ASSERT_EQ(told_N(), 0);
  }
}

TEST_F(GripSeam, AForceRestsWhenThePoseIsLost) {
  push({2, 0, 0});
  grip->known = false;
  tick(42);  // the tick that loses it, 40 ms, and one that sees the end
  EXPECT_EQ(told_N(), 0);
  EXPECT_FALSE(told().fresh);
}

TEST_F(GripSeam, FaultsEndInALostGripThatBeginsFromZero) {
  push({2, 0, 0});
  const double before_N = told_N();
  grip->answer = ExchangeStatus::kTimeout;
  for (int i = 0; i < HapticLoop::kMaxErrors; ++i) {
    EXPECT_FALSE(loop->lost());
    tick();
    EXPECT_LE(told_N(), before_N);
  }
  ASSERT_TRUE(loop->lost());
  const size_t count = grip->commands.size();
  tick(10);
  EXPECT_EQ(grip->commands.size(), count);
  grip->present = false;
  EXPECT_FALSE(loop->reopen());
  grip->present = true;
  grip->answer = ExchangeStatus::kOk;
  ASSERT_TRUE(loop->reopen());
  tick();
  EXPECT_EQ(told_N(), 0);
  EXPECT_LE(told().power, 1e-3 / HapticLoop::kEnergise_s);
}

TEST_F(GripSeam, ClosingSwitchesOffByARamp) {
  push({2, 0, 0});
  loop->begin_close();
  double last = told().power;
  for (int ms = 0; ms < 50; ++ms) {
    tick();
    EXPECT_LE(last - told().power, 1e-3 / HapticLoop::kRelease_s + 1e-12);
    last = told().power;
  }
  tick();
  EXPECT_TRUE(loop->released());
  EXPECT_EQ(told().power, 0);
  EXPECT_EQ(told_N(), 0);
  loop->close();
  EXPECT_FALSE(grip->is_open);
}

TEST_F(GripSeam, VibrationIsCountedForTheHand) {
  push({0.5, 0, 0});
  for (int i = 0; i < 2000; ++i) {
    play({i % 2 == 0 ? 3.0 : -3.0, 0, 0});
    tick(20);
  }
  EXPECT_LT(loop->snapshot().vibration.left, 1);
}

class GripThatFlies : public GripSeam {
 protected:
  GripThatFlies() : GripSeam(true) {}
};

TEST_F(GripThatFlies, IsLeftAloneWhenNobodyHoldsIt) {
  push({2, 0, 0});
  for (int ms = 0; ms < 100; ++ms) {
    grip->position_m.x() += 1.6e-3;  // faster than GripBrake::kFastest_m_s
    tick();
  }
  EXPECT_FALSE(loop->snapshot().last.held);
  EXPECT_LT(told().wrench.force_N.x(), 0);  // the damper alone
}

/// A stick that swings back when a hand lets go is no danger: it stays on its base.
TEST_F(GripSeam, AStickThatSwingsKeepsItsForce) {
  push({2, 0, 0});
  for (int ms = 0; ms < 100; ++ms) {
    grip->position_m.x() += 1.6e-3;
    tick();
  }
  EXPECT_TRUE(loop->snapshot().last.held);
  EXPECT_EQ(told_N(), 2);
}

}  // namespace
}  // namespace spidar::test::grip_seam_test
