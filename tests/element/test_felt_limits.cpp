// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Why little is felt of what the film or the picture would give: vibration, and touch.
#include "core/force/motion_rendering.h"
#include "spidar/limits/vibration_budget.h"
#include "tests/element/no_force_reason_test.h"
#include "tests/support/test.h"

namespace spidar::test::felt_limits_test {
namespace {

/// Grey levels below 128 are behind the grip, which a hand holds in the middle.
GstBuffer* level_frame(const GstVideoInfo& info, int grey) {
  return make_picture(info, [grey](int, int) { return grey; });
}

// The store is empty from the beginning.
TEST_F(NoForceReasonTest, TheFilmShakesTheHand) {
  const auto drain = [&] { loop().vibration().restore(time_ns + 24 * 3600 * 1'000'000'000LL); };
  // A strobe: the whole picture jumps to and fro.
  open("device=sim motion=camera filter-min-cutoff=0");
  play();
  drain();
  const auto strobe = [&](int n) { return make_frame(h->info(), n % 2 == 0 ? 0 : 4, 0); };
  show(kFrames, strobe);
  expect_of_device("vibration");
  ASSERT_EQ(h->warnings().size(), 1u);
  EXPECT_NE(h->warnings()[0].find("shaken"), std::string::npos) << h->warnings()[0];
  show(kFrames, strobe);
  EXPECT_EQ(h->warnings().size(), 1u) << "is said once";

  // A flicker, whose surface comes and goes under the grip: because surfaces rise slowly, this is
  // less than the action value, which may last for eight hours.
  frames = 0;
  open("device=sim touch=luma");
  play();
  const int64_t begin_ns = time_ns;
  loop().vibration().restore(begin_ns + 3600 * 1'000'000'000LL);
  show(kFrames, [&](int n) { return level_frame(h->info(), n % 2 == 0 ? 20 : 235); });
  const int64_t taken_ns = loop().vibration().full_at_ns() - begin_ns - 3600 * 1'000'000'000LL;
  const double mean_m2_s4 = VibrationBudget::kRefill_m2_s4 * static_cast<double>(taken_ns) /
                            static_cast<double>(time_ns - begin_ns);
  EXPECT_LT(std::sqrt(mean_m2_s4), VibrationBudget::kActionValue_m_s2);
}

TEST_F(NoForceReasonTest, TouchingTheReasonsAreThoseOfTheContact) {
  open("device=sim touch=luma");
  play();
  show(kFrames, [&](int) { return level_frame(h->info(), 20); });
  expect_of_device("not-touching");
  show(kFrames, [&](int) { return level_frame(h->info(), 235); });
  EXPECT_EQ(stats_field("device-no-force-reason"), "none") << "a picture that never moves is felt";
  g_object_set(h->element(), "max-force", kFeltForce_N / 2, nullptr);
  show(kFrames, [&](int) { return level_frame(h->info(), 235); });
  expect_of_device("light-touch");
  g_object_set(h->element(), "max-force", 3.0, nullptr);
  Pose hand;
  hand.position_m.z() = 0.02;
  device().set_hand(hand);
  show(15, [&](int) { return level_frame(h->info(), 235); });
  EXPECT_EQ(stats_field("device-no-force-reason"), "none") << "felt until 0.6 s ago at most";
  show(kFrames, [&](int) { return level_frame(h->info(), 235); });
  expect_of_device("not-touching");
  gst_harness_push_event(h->harness(), gst_event_new_eos());
  tick(100);
  EXPECT_EQ(stats_field("device-no-force-reason"), "ended");
}

TEST_F(NoForceReasonTest, ADeviceThatCannotTouchIsNamed) {
  for (const std::string device : {"sim:mouse", "sim:ff"}) {
    SCOPED_TRACE(device);
    frames = 0;
    open("touch=luma device=" + device);
    play();
    show(kFrames, [&](int) { return level_frame(h->info(), 235); });
    expect_of_device("cannot-touch");
    ASSERT_EQ(h->warnings().size(), 1u);
    EXPECT_NE(h->warnings()[0].find(device + " cannot touch the picture"), std::string::npos)
        << h->warnings()[0];
  }
}

TEST_F(NoForceReasonTest, AGripWithoutAPositionCannotPoint) {
  open("device=sim:mouse motion=objects pointer=grip");
  play();
  show_moved(3, 2);
  ASSERT_EQ(h->warnings().size(), 1u);
  EXPECT_NE(h->warnings()[0].find("sim:mouse cannot point"), std::string::npos) << h->warnings()[0];
  frames = 0;
  open("device=sim motion=objects pointer=grip");
  play();
  show_moved(3, 2);
  EXPECT_TRUE(h->warnings().empty());
}

}  // namespace
}  // namespace spidar::test::felt_limits_test
