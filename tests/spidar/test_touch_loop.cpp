// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A surface in the haptic loop: its force, and when it ends. Without a surface nothing changes.
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/string_grip.h"
#include "spidar/loop/tick_trace.h"
#include "tests/spidar/loop_driver.h"
#include "tests/support/allocation_count.h"
#include "tests/support/rest_force.h"
#include "tests/support/test.h"
#include "tests/support/tick_watch.h"
#include "tests/support/touch_frames.h"

namespace spidar::test::touch_loop_test {
namespace {

constexpr int64_t kFrame = 40 * kMs;
constexpr double kWidth_m = 0.059;
constexpr double kHeight_m = 0.064;

/// A loop on the simulated device, whose hand holds the grip where the test says.
struct Hand {
  explicit Hand(size_t slots = 8)
      : mailbox(kWidth_m, kHeight_m, slots),
        device(profile, SimulatedDevice::Time::kFixedStep),
        loop(std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device))) {
    loop->connect_touch(&mailbox);
    loop->open();
    for (int n = 0; n < 300; ++n) tick();
  }

  TickRecord tick() {
    now_ns += kTick_ns;
    const TickRecord record = watch.tick(*loop, now_ns);
    FeltState newest;
    while (device.pop_felt(newest)) felt = newest;
    return record;
  }
  TickRecord run(int ticks) {
    TickRecord record;
    for (int n = 0; n < ticks; ++n) record = tick();
    return record;
  }
  double fastest_m_s(int ticks) {
    double fastest = 0;
    for (int n = 0; n < ticks; ++n) {
      tick();
      fastest = std::max(fastest, felt.velocity_m_s.norm());
    }
    return fastest;
  }
  void play(int64_t running_ns) { loop->set_playback_clock({now_ns, running_ns, 1.0, true}); }
  void pause() { loop->set_playback_clock({now_ns, 0, 1.0, false}); }
  void hold(double x_m, double y_m, double z_m) {
    Pose pose;
    pose.position_m = {x_m, y_m, z_m};
    device.set_hand(pose);
  }

  const Profile profile = load_profile(kDefaultProfile);
  touch::Mailbox mailbox;
  SimulatedDevice device;
  std::unique_ptr<HapticLoop> loop;
  TickWatch watch;
  FeltState felt;
  int64_t now_ns = 7'000'000'000'000;
};

std::string row_of(const TickRecord& record) {
  std::string row;
  append_row(record, row);
  return row;
}

/// Three loops: one without a mailbox, one with an empty mailbox, and one whose mailbox was
/// emptied. Random frames, poses, pauses, flushes and faults give the same results, to the last
/// bit.
TEST(TouchLoop, WithoutASurfaceNothingIsDifferent) {
  LoopDriver plain;
  LoopDriver empty;
  LoopDriver released;
  touch::Mailbox nothing(kWidth_m, kHeight_m, 3);
  touch::Mailbox taken_back(kWidth_m, kHeight_m, 3);
  empty.loop->connect_touch(&nothing);
  released.loop->connect_touch(&taken_back);
  publish_plane(taken_back, 0, 0.02);
  taken_back.clear();
  publish_nothing(taken_back, 0);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int64_t frames = 0;
  Pose pose;
  int felt = 0;
  for (LoopDriver* driver : {&plain, &empty, &released}) {
    driver->open();
    driver->play(0);
  }
  for (int n = 0; n < 4000; ++n) {
    const bool frame_due = n % 33 == 0;
    const Wrench wrench{{2 * uniform(random), 2 * uniform(random), uniform(random)},
                        {0, 0, 0.05 * uniform(random)}};
    pose.position_m = 0.999 * pose.position_m +
                      2e-4 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    const auto what = random() % 1000;
    if (frame_due) ++frames;
    std::string rows[3];
    int k = 0;
    for (LoopDriver* driver : {&plain, &empty, &released}) {
      if (frame_due) driver->loop->schedule({frames * 33 * kMs, 43 * kMs, wrench});
      if (what == 0) driver->loop->cancel_scheduled();
      if (what == 1) driver->pause();
      if (what == 2) driver->play(n * kMs);
      driver->log().answer = what == 3 ? LinkFault::kTimeout : LinkFault::kNone;
      put_grip(*driver, pose);
      const TickRecord record = driver->tick();
      rows[k++] = row_of(record);
      felt += record.commanded.force_N.norm() > 0.1;
    }
    ASSERT_EQ(rows[1], rows[0]) << n;
    ASSERT_EQ(rows[2], rows[0]) << n;
    ASSERT_EQ(empty.log().last_volts.volt, plain.log().last_volts.volt) << n;
    ASSERT_EQ(released.log().last_volts.volt, plain.log().last_volts.volt) << n;
  }
  EXPECT_GT(felt, 2000) << "it is forces that are compared";
}

TEST(TouchLoop, APlaneIsStiffnessTimesDepthInTheHand) {
  for (const double stiffness_N_m : {300.0, 500.0, 800.0}) {
    Hand hand;
    touch::ContactSettings contact;
    contact.stiffness_N_m = stiffness_N_m;
    publish_plane(hand.mailbox, 0, 0.001, After::kCut, contact);
    hand.play(0);
    hand.hold(0, 0, -0.009);
    hand.run(2000);
    double force_N = 0;
    double depth_m = 0;
    constexpr int kTicks = 500;
    for (int n = 0; n < kTicks; ++n) {
      hand.tick();
      force_N +=
          (hand.felt.wrench.force_N - rest_force_N(hand.profile, hand.felt.pose)).z() / kTicks;
      depth_m += (0.001 - hand.felt.pose.position_m.z()) / kTicks;
    }
    EXPECT_GT(depth_m, 0.002);
    EXPECT_NEAR(force_N / (stiffness_N_m * depth_m), 1, 0.005) << stiffness_N_m;
  }
}

TEST(TouchLoop, IsAddedToTheFilmAndLimitedWithIt) {
  Hand hand;
  publish_plane(hand.mailbox, 0, 0.001);
  for (int64_t n = 0; n < 100; ++n) hand.loop->schedule({n * kFrame, kFrame, push_right(1)});
  hand.play(0);
  hand.hold(0, 0, -0.005);
  for (int n = 0; n < 3000; ++n) {
    const TickRecord record = hand.tick();
    const Eigen::Vector3d film_N = record.wanted.force_N - record.contact.force_N;
    if (record.contact.has_surface) {
      ASSERT_NEAR((film_N - push_right(1).force_N).norm(), 0, 1e-12);
    }
    ASSERT_LE(record.commanded.force_N.norm(), SafetyLimits{}.max_force_N * (1 + 1e-12));
  }
  EXPECT_GT(hand.tick().contact.force_N.z(), 0.5);
  // A second after the last frame, nothing of it is left.
  const TickRecord later = hand.run(2000);
  EXPECT_NEAR((later.wanted.force_N - later.contact.force_N).norm(), 0, 1e-12);
  // Deeper than the limit allows: the total is 3 N, in the direction of the sum.
  hand.hold(0, 0, -0.030);
  const TickRecord record = hand.run(500);
  EXPECT_GT(record.wanted.force_N.norm(), 3);
  EXPECT_NEAR(record.commanded.force_N.norm(), 3, 1e-9);
}

TEST(TouchLoop, HoldsWithoutFramesAndEndsWithPlayback) {
  Hand hand;
  publish_plane(hand.mailbox, 0, 0.001);
  hand.play(0);
  hand.hold(0, 0, -0.005);
  EXPECT_GT(hand.run(5000).commanded.force_N.z(), 0.5) << "five seconds after the only frame";
  hand.pause();
  EXPECT_EQ(hand.run(50).commanded.stacked().norm(), 0);
  hand.run(1000);  // the hand sinks in, and rests there
  hand.play(0);
  EXPECT_LE(hand.fastest_m_s(1000), 0.05) << "the surface rises from the grip";
  EXPECT_GT(hand.tick().commanded.force_N.z(), 0.5);
  hand.mailbox.clear();
  EXPECT_EQ(hand.run(50).commanded.stacked().norm(), 0);
  hand.run(1000);
  publish_plane(hand.mailbox, 0, 0.001);
  EXPECT_LE(hand.fastest_m_s(1000), 0.05);
  EXPECT_GT(hand.tick().commanded.force_N.z(), 0.5);
  // Nothing to touch any more, and no frame: rest.
  publish_nothing(hand.mailbox, 0);
  EXPECT_EQ(hand.run(50).commanded.stacked().norm(), 0);
  hand.run(1000);
  publish_plane(hand.mailbox, 0, 0.001);
  EXPECT_LE(hand.fastest_m_s(1000), 0.05);
  // The clock is not refreshed any more.
  hand.loop->set_playback_clock({hand.now_ns, 0, 1.0, true, hand.now_ns + 500 * kMs});
  EXPECT_GT(hand.run(499).commanded.force_N.z(), 0.5);
  EXPECT_EQ(hand.run(51).commanded.stacked().norm(), 0);
}

TEST(TouchLoop, NothingIsTouchedWithoutAPose) {
  Hand hand;
  publish_plane(hand.mailbox, 0, 0.001);
  hand.play(0);
  hand.hold(0, 0, -0.005);
  EXPECT_GT(hand.run(1000).commanded.force_N.z(), 0.5);
  // Replies that are missing: not so many that the device is lost, but the pose is.
  hand.device.set_fault(LinkFault::kTimeout);
  EXPECT_FALSE(hand.run(HapticLoop::kMaxErrors - 1).contact.has_surface);
  hand.device.set_fault(LinkFault::kNone);
  bool rested = false;
  for (int n = 0; n < 1000; ++n) {
    const bool at_rest = hand.tick().commanded.stacked().norm() == 0;
    rested = rested || at_rest;
  }
  EXPECT_TRUE(rested);
  EXPECT_GT(hand.tick().commanded.force_N.z(), 0.5) << "and again with a pose";
  // Encoders that say something impossible.
  for (int string = 0; string < 3; ++string) hand.device.set_count_error(string, 3000);
  const TickRecord record = hand.run(100);
  EXPECT_FALSE(record.contact.has_surface);
  EXPECT_EQ(record.commanded.stacked().norm(), 0);
}

TEST(TouchLoop, ALostDeviceComesBackWithoutAKick) {
  Hand hand;
  publish_plane(hand.mailbox, 0, 0.001);
  hand.play(0);
  hand.hold(0, 0, -0.005);
  EXPECT_GT(hand.run(1000).commanded.force_N.z(), 0.5);
  hand.device.set_fault(LinkFault::kGone);
  hand.tick();
  ASSERT_TRUE(hand.loop->lost());
  hand.device.set_fault(LinkFault::kNone);
  ASSERT_TRUE(hand.loop->reopen());
  // The hand itself takes the grip from the centre to where it is held, at up to 0.1 m/s.
  Hand untouched;
  untouched.hold(0, 0, -0.005);
  EXPECT_LE(hand.fastest_m_s(1000), untouched.fastest_m_s(1000) + 0.05);
  EXPECT_GT(hand.tick().commanded.force_N.z(), 0.5);
}

TEST(TouchLoop, ATickTakesNothingFromTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "a sanitizer has the heap";
  Hand hand;
  hand.play(0);
  hand.hold(0, 0, -0.005);
  int64_t frames = 0;
  for (int n = 0; n < 3000; ++n) {
    if (n % 40 == 0) {
      publish_plane(hand.mailbox, n * kMs, 1e-4 * (n % 7),
                    frames++ > 0 ? After::kFrame : After::kCut);
    }
    hand.now_ns += kTick_ns;
    const long before = allocations;
    hand.loop->tick(hand.now_ns, hand.now_ns);
    ASSERT_EQ(allocations, before) << n;
  }
  EXPECT_GT(hand.loop->snapshot().last.contact.force_N.z(), 0.5);
}

}  // namespace
}  // namespace spidar::test::touch_loop_test
