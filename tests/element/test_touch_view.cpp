// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What of the touched surface leaves the element for the window and `stats`, and how the hand of
// the simulated device is led through the element.
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "plugin/filter/display/motion_display.h"
#include "plugin/filter/spidar_motion.h"
#include "spidar/devices/sim/simulated_device.h"
#include "tests/support/element_harness.h"
#include "tests/support/video_frames.h"

namespace spidar::test::touch_view_test {
namespace {

TEST(TouchView, TheLedHandOfTheSimulatedDeviceFeelsTheSurface) {
  int64_t time_ns = 1'000'000'000;
  ElementHarness h("device=sim touch=luma touch-stiffness=400", [&] { return time_ns; });
  h.set_caps(make_caps("GRAY8", 320, 240));
  const auto tick = [&](int count) {
    for (int i = 0; i < count; ++i) h.tick(time_ns += kTick_ns);
  };
  tick(300);
  PlaybackClock clock;
  clock.playing = true;
  clock.monotonic_ns = time_ns;
  h.state().feed.output.session()->loop().set_playback_clock(clock);
  GstBuffer* const grey = gst_buffer_new_allocate(nullptr, 320 * 240, nullptr);
  gst_buffer_memset(grey, 0, 20, 320 * 240);  // 3.4 mm behind the middle
  ASSERT_EQ(h.push(grey, 0), GST_FLOW_OK);
  const std::shared_ptr<window::Source> source =
      gst_spidar_motion_state(GST_SPIDAR_MOTION(h.element())).display.source();
  window::ElementState state;
  const auto look = [&] {
    tick(1500);
    source->read(state);
    return state.device.value().last;
  };
  EXPECT_FALSE(look().contact.touching);
  ASSERT_TRUE(state.device->has_hand);
  source->lead_hand(Eigen::Vector3d(0.01, 0, -0.01));
  const TickRecord held = look();
  ASSERT_TRUE(held.contact.touching);
  // The hand's spring (300 N/m) and the surface (400 N/m) share 6.6 mm: 1.14 N, but for the
  // strings, which stiffen the grip by some hundredths, and the steps of encoders and D/A.
  EXPECT_NEAR(held.contact.force_N.z(), 6.627e-3 / (1 / 300.0 + 1 / 400.0), 0.1);
  // Friction of 0.3 holds it back, at a depth of 2.8 mm.
  EXPECT_NEAR(held.contact.proxy_m.x(), held.pose.position_m.x(), 1e-3);
  source->lead_hand(std::nullopt);
  EXPECT_FALSE(look().contact.touching) << "the hand has let go";

  GstStructure* stats = nullptr;
  g_object_get(h.element(), "stats", &stats, nullptr);
  double stiffness_N_m = 0;
  EXPECT_TRUE(gst_structure_get_double(stats, "touch-stiffness", &stiffness_N_m));
  EXPECT_EQ(stiffness_N_m, 400);
  gst_structure_free(stats);
}

TEST(TouchView, OtherDevicesHaveNoHandToLead) {
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
}  // namespace spidar::test::touch_view_test
