// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The device while the video plays: it may fail and return, and is always brought to rest.
#include "spidar/profiles/profile.h"
#include "tests/element/simulated_element.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"

namespace spidar::test::device_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;

class DeviceTest : public SimulatedElement {
 protected:
  GstFlowReturn push_next() {
    const int n = frames++;
    return h->push_moved(2.0 * n, 0, static_cast<GstClockTime>(n) * kFrame);
  }

  double force_N() { return loop().snapshot().last.commanded.force_N.norm(); }
};

TEST_F(DeviceTest, IsAtRestWhileAGapIsShown) {
  open("device=sim");
  for (int n = 0; n < 3; ++n) push_next();
  for (int n = 0; n < 6; ++n) {
    h->push_moved(99, 0, static_cast<GstClockTime>(frames++) * kFrame, GST_BUFFER_FLAG_GAP);
  }
  for (int n = 0; n < 3; ++n) push_next();
  play();
  tick(2 * 40);
  EXPECT_GT(force_N(), 0.1);
  // The first frame of the gap could still belong to the motion. On the way to rest until the
  // second one, and a little longer for the slew limit.
  tick(2 * 40 + 50);
  for (int ms = 4 * 40 + 50; ms < 9 * 40; ++ms) {
    EXPECT_EQ(force_N(), 0) << ms;
    tick();
  }
  tick(2 * 40);
  EXPECT_GT(force_N(), 0.1) << "there were two frames again to compare";
}

TEST_F(DeviceTest, MaxForceIsBoundedByWhatTheProfileCanGive) {
  open("device=sim max-force=20 controller=nonlinear alpha=1");
  const double most_N = largest_force_N(h->state().feed.output.profile());
  ASSERT_LT(most_N, 20);
  ASSERT_EQ(h->warnings().size(), 1u);
  EXPECT_NE(h->warnings()[0].find("max-force=20 is more than the"), std::string::npos)
      << h->warnings()[0];
  for (int n = 0; n < 12; ++n) push_next();
  play();
  double largest_N = 0;
  for (int ms = 0; ms < 10 * 40; ++ms) {
    tick();
    largest_N = std::max(largest_N, force_N());
  }
  EXPECT_LE(largest_N, most_N + 1e-9);
  EXPECT_GT(largest_N, 0.9 * most_N) << "the limit is not far below what can be given";
  g_object_set(h->element(), "max-force", 19.0, nullptr);
  EXPECT_EQ(h->warnings().size(), 1u) << "said once";
}

TEST_F(DeviceTest, ALossIsAWarningAndTheVideoContinues) {
  open("device=sim");
  push_next();
  tick(300);
  EXPECT_EQ(push_next(), GST_FLOW_OK);
  device().set_fault(LinkFault::kGone);
  tick(2);
  for (int n = 0; n < 3; ++n) EXPECT_EQ(push_next(), GST_FLOW_OK);
  ASSERT_EQ(h->warnings().size(), 1u) << "said once, not once per frame";
  EXPECT_NE(h->warnings()[0].find("device"), std::string::npos);
  EXPECT_TRUE(h->errors().empty());

  EXPECT_FALSE(loop().reopen()) << "the fault stands";
  device().set_fault(LinkFault::kNone);
  EXPECT_TRUE(loop().reopen());
  tick(300);
  EXPECT_EQ(push_next(), GST_FLOW_OK);
  EXPECT_EQ(h->state().feed.output.snapshot()->last.device, DeviceState::kRunning);

  device().set_fault(LinkFault::kGone);
  tick(2);
  EXPECT_EQ(push_next(), GST_FLOW_OK);
  EXPECT_EQ(h->warnings().size(), 2u) << "lost a second time";

  const auto reopen = [&] {
    device().set_fault(LinkFault::kNone);
    EXPECT_TRUE(loop().reopen());
    tick(300);
  };
  reopen();
  EXPECT_EQ(push_next(), GST_FLOW_OK);
  EXPECT_EQ(h->warnings().size(), 2u);
  device().set_fault(LinkFault::kGone);
  tick(2);
  reopen();
  EXPECT_EQ(push_next(), GST_FLOW_OK);
  EXPECT_EQ(h->warnings().size(), 3u) << "lost and back between two frames";
  EXPECT_EQ(push_next(), GST_FLOW_OK);
  EXPECT_EQ(h->warnings().size(), 3u);
}

TEST_F(DeviceTest, ALossIsAnErrorIfRequested) {
  open("device=sim on-device-error=error");
  push_next();
  tick(300);
  EXPECT_EQ(push_next(), GST_FLOW_OK);
  device().set_fault(LinkFault::kGone);
  tick(2);
  EXPECT_EQ(push_next(), GST_FLOW_ERROR);
  EXPECT_EQ(h->errors().size(), 1u);
  EXPECT_TRUE(h->warnings().empty());
}

TEST_F(DeviceTest, AFaultyStringIsNamedOnceAndInTheStats) {
  open("device=sim");
  push_next();
  tick(300);
  EXPECT_EQ(push_next(), GST_FLOW_OK);
  EXPECT_TRUE(h->warnings().empty());
  device().set_count_error(5, 100);  // 1.5 mm
  tick(2);
  for (int n = 0; n < 3; ++n) EXPECT_EQ(push_next(), GST_FLOW_OK);
  ASSERT_EQ(h->warnings().size(), 1u) << "said once, not once per frame";
  EXPECT_NE(h->warnings()[0].find("String 5"), std::string::npos) << h->warnings()[0];
  EXPECT_EQ(h->stats_field("faulty-string"), "5");
}

TEST_F(DeviceTest, TheGripPointsAtWhatIsFelt) {
  open("device=sim motion=objects pointer=grip");
  constexpr int kWidth = 320, kHeight = 240;
  MovingScene scene(kWidth, kHeight);
  scene.plain_background();
  scene.add_disc(36);
  scene.add_disc(36);
  tick(300);  // strings are taut
  Pose hand;
  for (const double side : {-1.0, 1.0}) {
    // Half of the way from the middle of the picture to its edge, which is half of the way to the
    // frame: 59 mm / 2.
    hand.position_m.x() = side * 0.059 / 4;
    device().set_hand(hand);
    // The simulated grip moves in real time, so the test waits for as long as necessary.
    while (side * loop().snapshot().last.pose.position_m.x() < 0.9 * 0.059 / 4) tick();
    h->state().film.begin_run();
    for (int n = 0; n < 6; ++n, ++frames) {
      // Apart from each other by 2 px a frame each.
      const ImageView view = scene.draw({}, {{{-80.0 - 2 * n, 0}}, {{80.0 + 2 * n, 0}}});
      h->push(gst_buffer_new_memdup(view.data, kWidth * kHeight),
              static_cast<GstClockTime>(frames) * kFrame);
    }
    // 50 px/s. The pointer is at least 0.9 · 80 px from the middle, the edge of the other disc 80 +
    // 10 − 36 px on the other side of it: together 126 px or 2.1 σ, which leaves that one exp(−2.1²
    // / 2) = 0.11 of the weight, and (1 − 0.11) / (1 + 0.11) = 0.80 of the speed if both boxes are
    // of one size. They are those around the points, which are 12 px apart: one may have half the
    // area of the other, and (1 − 0.22) / (1 + 0.22) = 0.64 is left.
    EXPECT_GT(side * h->motions().back().velocity_x, 0.64 * 50) << side;
  }
}

TEST_F(DeviceTest, ALowerMaxForceIsApproachedFromTheNextTickOnAndNeedsNoFrame) {
  open("device=sim alpha=0.01");
  play();
  for (int n = 0; n < 5; ++n) {
    push_next();
    tick(40);
  }
  push_next();
  tick();
  ASSERT_GT(force_N(), 0.5) << "50 px/s by eq. 15: 0.89 N";
  g_object_set(h->element(), "max-force", 0.25, nullptr);
  tick();
  EXPECT_GT(force_N(), 0.5 - 0.3 - 1e-12) << "at 300 N/s";
  // At 300 N/s from 0.89 N: three ticks, after the one in which the loop receives the limit.
  tick(4);
  EXPECT_LE(force_N(), 0.25 * (1 + 1e-12));  // the rounding of a vector that is shortened
  EXPECT_GT(force_N(), 0.2);
}

TEST_F(DeviceTest, MaxForceOfAClosedElementHoldsWhenItOpens) {
  open("device=sim");
  gst_element_set_state(h->element(), GST_STATE_NULL);
  g_object_set(h->element(), "max-force", 0.25, nullptr);
  gst_element_set_state(h->element(), GST_STATE_PLAYING);
  tick();
  EXPECT_EQ(loop().snapshot().limits.max_force_N, 0.25);
}

TEST_F(DeviceTest, IsAtRestWhenTheElementIsClosed) {
  open("device=sim");
  for (int n = 0; n < 3; ++n) push_next();
  tick(300);
  EXPECT_GT(device().felt().tension_N.minCoeff(), 0) << "strings are taut while it is open";
  gst_element_set_state(h->element(), GST_STATE_NULL);
  EXPECT_EQ(h->state().feed.output.session(), nullptr);
}

}  // namespace
}  // namespace spidar::test::device_test
