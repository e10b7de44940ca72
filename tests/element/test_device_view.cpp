// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What a window sees of the device.
#include "plugin/device/device_view.h"
#include "plugin/filter/display/motion_display.h"
#include "plugin/filter/spidar_motion.h"
#include "tests/element/simulated_element.h"
#include "tests/support/test.h"

namespace spidar::test::device_view_test {
namespace {

using DeviceViewed = SimulatedElement;

/// Between two pictures of a screen lie some sixteen ticks.
TEST_F(DeviceViewed, ALookSeesTheForcesOfAllTicksSinceTheLastOne) {
  open("device=sim motion=mean");
  HapticOutput& output = h->state().feed.output;
  play();
  DeviceView view;
  TickRecord record;
  output.read_device(view);
  while (loop().pop_record(record)) {
  }
  double widest_N = 0;
  for (int n = 0; n < 30; ++n) {
    ASSERT_EQ(h->push_moved(2.0 * n, 0, static_cast<GstClockTime>(n) * 40 * GST_MSECOND),
              GST_FLOW_OK);
    tick(40);
    ASSERT_TRUE(output.read_device(view));
    ASSERT_EQ(view.ticks.size(), 40u);
    for (const ForceTick& seen : view.ticks) {
      ASSERT_TRUE(loop().pop_record(record));
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
