// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which surface is touched at each moment.
#include "spidar/touch/touch_rendering.h"
#include "tests/support/test.h"
#include "tests/support/touch_frames.h"

namespace spidar::test::touch_rendering_test {
namespace {

constexpr int64_t kMs = 1'000'000;
constexpr int64_t kFrame = 40 * kMs;
constexpr double kTick_s = 1e-3;
/// Heights are floats of some millimetres.
constexpr double kRounding_m = 1e-9;

/// A grip that stands still 5 mm below the middle, a tick a millisecond.
struct Touched {
  explicit Touched(size_t slots = 64) : mailbox(0.06, 0.04, slots) {}

  touch::Contact tick() {
    now_ns += kMs;
    return rendering.tick(mailbox, now_ns, grip_m, kTick_s);
  }
  touch::Contact run(int64_t until_ns) {
    touch::Contact last;
    while (now_ns < until_ns) last = tick();
    return last;
  }

  touch::Mailbox mailbox;
  touch::Rendering rendering;
  Eigen::Vector3d grip_m{0, 0, -0.005};
  int64_t now_ns = -kMs;
};

/// Of frame n: a saw of 1 mm up, 1 mm down.
double saw_m(int64_t n) {
  return n % 2 == 0 ? 0 : 0.001;
}

TEST(TouchRendering, GoesFromFrameToFrameInTime) {
  Touched touched;
  for (int64_t n = 0; n < 60; ++n) {
    publish_plane(touched.mailbox, n * kFrame, saw_m(n), n == 0 ? After::kCut : After::kFrame);
  }
  touched.run(10 * kFrame);  // the surface rises from the grip to its position
  for (int tick = 0; tick < 1000; ++tick) {
    const touch::Contact contact = touched.tick();
    const int64_t n = touched.now_ns / kFrame;
    const double fraction = static_cast<double>(touched.now_ns % kFrame) / kFrame;
    const double z_m = (1 - fraction) * saw_m(n) + fraction * saw_m(n + 1);
    ASSERT_TRUE(contact.touching);
    ASSERT_NEAR(contact.depth_m, 0.005 + z_m, kRounding_m) << "at " << touched.now_ns;
    ASSERT_NEAR((contact.proxy_m - Eigen::Vector3d(0, 0, z_m)).norm(), 0, kRounding_m);
  }
}

TEST(TouchRendering, AFrameThatIsKnownLateIsReachedFromThenOn) {
  Touched touched;
  publish_plane(touched.mailbox, 0, 0);
  touched.run(10 * kFrame);
  // Published 20 ms before it is due.
  publish_plane(touched.mailbox, touched.now_ns + 20 * kMs, 0.0005, After::kFrame);
  const double before_m = touched.tick().depth_m;
  EXPECT_NEAR(before_m, 0.005, kRounding_m) << "no step when it becomes known";
  for (int tick = 1; tick < 20; ++tick) {
    // It became known a millisecond after it was published.
    const double fraction = std::min(1.0, tick / 19.0);
    ASSERT_NEAR(touched.tick().depth_m, 0.005 + 0.0005 * fraction, kRounding_m) << tick;
  }
  // And one that is known when it is due already: within kShortest_ns.
  touched.run(touched.now_ns + kFrame);
  publish_plane(touched.mailbox, touched.now_ns, 0, After::kFrame);
  touched.tick();
  double last_m = 0.0055;
  for (int tick = 1; tick <= touch::Rendering::kShortest_ns / kMs; ++tick) {
    const double depth_m = touched.tick().depth_m;
    EXPECT_NEAR(last_m - depth_m, 0.0005 / 15, kRounding_m);
    last_m = depth_m;
  }
  EXPECT_NEAR(touched.tick().depth_m, 0.005, kRounding_m);
}

/// A frame 5 mm higher, 40 ms later: nothing that was seen to move explains it, or it is another
/// scene.
TEST(TouchRendering, AFlashOrACutIsThereWhenItIsDueAndRisesSlowly) {
  for (const After after : {After::kFrame, After::kCut}) {
    Touched touched;
    publish_plane(touched.mailbox, 0, 0);
    publish_plane(touched.mailbox, 10 * kFrame, 0, After::kFrame);
    publish_plane(touched.mailbox, 11 * kFrame, 0.005, after);
    double last_m = touched.run(11 * kFrame - kMs).depth_m;
    EXPECT_NEAR(last_m, 0.005, kRounding_m) << "nothing of it before it is due";
    for (int tick = 0; tick < 1000; ++tick) {
      const double depth_m = touched.tick().depth_m;
      // One tick at the speed of the fastest surface, which is what it may be; then it rises.
      const double most_m_s = tick == 0 ? touch::Proxy::kFastest_m_s : touch::Proxy::kRise_m_s;
      ASSERT_LE(depth_m - last_m, most_m_s * kTick_s + 1e-12);
      last_m = depth_m;
    }
    EXPECT_NEAR(last_m, 0.010, kRounding_m);
  }
}

/// A slope that passes at 50 mm/s lifts the surface under the grip at as much: that is a motion.
TEST(TouchRendering, WhatMovesMayRiseFaster) {
  constexpr double kSpeed_m_s = 0.05;
  Touched touched(16);
  for (int64_t n = 0; n < 16; ++n) {
    const double moved_m = kSpeed_m_s * 1e-9 * static_cast<double>(n * kFrame);
    touch::Surface* const frame = touched.mailbox.begin(touched.mailbox.generation());
    frame->time_ns = n * kFrame;
    frame->has_surface = true;
    frame->follows = n > 0;
    frame->displacement_m = {-kSpeed_m_s * 1e-9 * static_cast<double>(kFrame), 0};
    for (int y = 0; y < touch::HeightField::kRows; ++y) {
      for (int x = 0; x < touch::HeightField::kColumns; ++x) {
        frame->relief.row(y)[x] = static_cast<float>(frame->relief.x_m(x) + moved_m - 0.015);
      }
    }
    touched.mailbox.publish();
  }
  // Straight above the grip: a slope of 1, its proxy as far up as the grip is below.
  touched.run(13 * kFrame);
  const double before_m = std::sqrt(2) * touched.tick().depth_m;
  const double after_m = std::sqrt(2) * touched.run(14 * kFrame + kMs).depth_m;
  EXPECT_NEAR(after_m - before_m, kSpeed_m_s * 0.04, 1e-6);
}

TEST(TouchRendering, KeepsUpWithFramesThatAreAllLate) {
  // 200 frames a second, each published 30 ms after it was due.
  constexpr int64_t kShort = 5 * kMs;
  Touched touched(8);
  for (int64_t n = 0; n < 2000; ++n) {
    ASSERT_TRUE(publish_plane(touched.mailbox, n * kShort, 0, After::kFrame)) << "full at " << n;
    touched.run(n * kShort + 30 * kMs);
  }
}

TEST(TouchRendering, NothingBeforeTheFirstFrameIsShown) {
  Touched touched;
  publish_plane(touched.mailbox, 100 * kMs, 0);
  EXPECT_FALSE(touched.run(99 * kMs).has_surface);
  EXPECT_TRUE(touched.tick().has_surface);
  // The clock's line is measured anew and is a little behind: the frame stays.
  touched.now_ns -= 2 * kMs;
  EXPECT_TRUE(touched.tick().has_surface);
}

TEST(TouchRendering, AStallIsNoKnock) {
  Touched touched;
  publish_plane(touched.mailbox, 0, 0);
  touched.run(20 * kFrame);
  touched.grip_m.z() = -0.009;
  touched.now_ns += 200 * kMs;
  const touch::Contact contact = touched.rendering.tick(touched.mailbox, touched.now_ns,  //
                                                        touched.grip_m, 0.2);
  EXPECT_LE(contact.force_N.norm(), 500 * touch::Proxy::kFastest_m_s * 0.2 + 1e-9);
  EXPECT_LE(contact.depth_m, 0.009);
}

TEST(TouchRendering, AnotherStiffnessIsReachedSlowly) {
  Touched touched;
  touch::ContactSettings stiff;
  stiff.stiffness_N_m = 800;
  touch::ContactSettings soft;
  soft.stiffness_N_m = 200;
  publish_plane(touched.mailbox, 0, 0, After::kCut, soft);
  publish_plane(touched.mailbox, 10 * kFrame, 0, After::kCut, stiff);
  double last_N = touched.run(10 * kFrame - kMs).force_N.z();
  EXPECT_NEAR(last_N, 200 * 0.005, 1e-6);
  for (int tick = 0; tick < 1000; ++tick) {
    const double now_N = touched.tick().force_N.z();
    ASSERT_LE(now_N - last_N, touch::Rendering::kStiffening_N_m_s * kTick_s * 0.005 + 1e-9);
    last_N = now_N;
  }
  // A stiffer spring at the same depth holds more energy, which the hand has not put in: the force
  // stays below that of the spring until the grip has pressed again.
  EXPECT_GT(last_N, 200 * 0.005);
  EXPECT_LT(last_N, 800 * 0.005);
  const double depth_m = touched.grip_m.z();
  for (int tick = 0; tick < 200; ++tick) {  // out and in again, at 0.1 m/s
    touched.grip_m.z() = depth_m + 1e-4 * (tick < 100 ? tick : 200 - tick);
    touched.tick();
  }
  touched.grip_m.z() = depth_m;
  const double pressed_N = touched.run(touched.now_ns + 2 * kFrame).force_N.z();
  EXPECT_GT(pressed_N, last_N);
  EXPECT_LE(pressed_N, 800 * 0.005 + 1e-9);
}

}  // namespace
}  // namespace spidar::test::touch_rendering_test
