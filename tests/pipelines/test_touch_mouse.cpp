// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The mouse in the window of a video sink is the finger of the simulated device.
#include <gst/video/navigation.h>

#include "plugin/frame/touch_view.h"
#include "tests/pipelines/touched_pipeline.h"
#include "tests/support/test.h"

namespace spidar::test::touch_mouse_test {
namespace {

/// To the element, in pixels of a frame of 320 × 240.
void send(GstElement* element, GstEvent* event) {
  GstPad* const source = gst_element_get_static_pad(element, "src");
  gst_pad_send_event(source, event);
  gst_object_unref(source);
}

TEST(TouchMouse, InTheWindowOfASinkLeadsTheSimulatedHand) {
  constexpr auto kNoKey = GST_NAVIGATION_MODIFIER_NONE;
  for (const std::string pointer : {"0.5,0.5", "mouse"}) {
    SCOPED_TRACE(pointer);
    Touched touched(touched_film("pattern=solid-color foreground-color=0xff808080",
                                 "motion=objects touch=luma pointer=" + pointer));
    GstElement* const element = touched.pipeline.element();
    const auto grip_m = [&] {
      touched.wait(1000);  // the hand needs 44 ms for its 22 mm
      return touched.last().pose.position_m;
    };
    touched.play(5);
    // Half of the way to the upper right corner.
    send(element, gst_navigation_event_new_mouse_button_press(1, 240, 60, kNoKey));
    const Eigen::Vector2d half_m =
        GripPointer(load_profile(kDefaultProfile).geometry).half_size_m() / 2;
    if (pointer != "mouse") {
      EXPECT_LT(grip_m().norm(), 1e-3) << "the mouse of a sink is nobody's";
      continue;
    }
    // The spring of the hand gives way to what the strings must pull at least.
    EXPECT_LT((grip_m().head<2>() - half_m).norm(), 2e-3);
    EXPECT_FALSE(touched.last().contact.touching) << "the surface is in the middle";
    for (int n = 0; n < 12; ++n) {
      send(element, n % 2 == 0 ? gst_navigation_event_new_mouse_scroll(240, 60, 0, 1, kNoKey)
                               : gst_navigation_event_new_mouse_button_press(4, 240, 60, kNoKey));
    }
    grip_m();
    // 6 mm deep, between the spring of the hand, 300 N/m, and that of the surface, 500 N/m.
    EXPECT_NEAR(touched.last().contact.depth_m, 6e-3 * 300 / 800, 1e-3);
    send(element, gst_navigation_event_new_mouse_button_release(1, 0, 0, kNoKey));
    EXPECT_LT(grip_m().norm(), 2e-3) << "released";
    send(element, gst_navigation_event_new_mouse_button_press(1, 240, 60, kNoKey));
    EXPECT_GT(grip_m().x(), half_m.x() / 2);
    g_object_set(element, "touch", 0, nullptr);
    touched.play(1);
    EXPECT_LT(grip_m().norm(), 2e-3) << "nothing is touched any more";
  }
}

}  // namespace
}  // namespace spidar::test::touch_mouse_test
