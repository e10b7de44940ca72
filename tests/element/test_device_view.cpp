// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What a window sees of the device.
#include "plugin/device/device_view.h"
#include "plugin/filter/display/motion_display.h"
#include "plugin/filter/spidar_motion.h"
#include "spidar/loop/haptic_loop.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test::device_view_test {
namespace {

/// Between two pictures of a screen lie some sixteen ticks.
TEST(DeviceView, ALookSeesTheForcesOfAllTicksSinceTheLastOne) {
  int64_t time_ns = 1'000'000'000;
  ElementHarness h("device=sim motion=mean", [&] { return time_ns; });
  h.set_caps(make_caps("GRAY8", 320, 240));
  HapticOutput& output = h.state().feed.output;
  HapticLoop& loop = output.session()->loop();
  const auto tick = [&](int count) {
    for (int i = 0; i < count; ++i) h.tick(time_ns += kTick_ns);
  };
  tick(300);
  PlaybackClock clock;
  clock.playing = true;
  clock.monotonic_ns = time_ns;
  loop.set_playback_clock(clock);
  DeviceView view;
  TickRecord record;
  output.read_device(view);
  while (loop.pop_record(record)) {
  }
  double widest_N = 0;
  for (int n = 0; n < 30; ++n) {
    ASSERT_EQ(h.push_moved(2.0 * n, 0, static_cast<GstClockTime>(n) * 40 * GST_MSECOND),
              GST_FLOW_OK);
    tick(40);
    ASSERT_TRUE(output.read_device(view));
    ASSERT_EQ(view.ticks.size(), 40u);
    for (const ForceTick& seen : view.ticks) {
      ASSERT_TRUE(loop.pop_record(record));
      EXPECT_EQ(seen.monotonic_ns, record.monotonic_ns);
      EXPECT_EQ(seen.wanted_N, record.wanted.force_N);
      EXPECT_EQ(seen.delivered_N, record.delivered.force_N);
    }
    widest_N =
        std::max(widest_N, (view.ticks.back().delivered_N - view.ticks.front().delivered_N).norm());
  }
  EXPECT_GT(widest_N, 0.1) << "the force changes between looks";
  // Where nobody looked for longer than ticks are kept, there are none rather than the first ones.
  tick(1000);
  output.read_device(view);
  EXPECT_EQ(view.ticks.size(), 1000u);
  for (const int count : {1100, 3000}) {
    tick(count);
    output.read_device(view);
    EXPECT_TRUE(view.ticks.empty()) << count;
  }
  tick(10);
  output.read_device(view);
  EXPECT_EQ(view.ticks.size(), 10u);
}

TEST(DeviceView, OnlyASimulatedGripHasAHandToLead) {
  for (const char* properties : {"device=sim:sh4", "device=none"}) {
    ElementHarness h(properties);
    const std::shared_ptr<window::Source> source =
        gst_spidar_motion_state(GST_SPIDAR_MOTION(h.element())).display.source();
    window::ElementState state;
    source->read(state);
    EXPECT_FALSE(state.device && state.device->has_hand) << properties;
    EXPECT_FALSE(h.state().feed.output.lead_hand(Eigen::Vector3d(0.01, 0, 0))) << properties;
    source->lead_hand(Eigen::Vector3d(0.01, 0, 0));
  }
}

}  // namespace
}  // namespace spidar::test::device_view_test
