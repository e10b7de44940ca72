// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The element with its overlay: which frames it draws into, and when.
#include "tests/element/simulated_element.h"
#include "tests/support/test.h"

namespace spidar::test::overlay_element_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;

/// Bytes of `a` that differ in `b`.
size_t differences(GstBuffer* a, GstBuffer* b) {
  GstMapInfo x, y;
  gst_buffer_map(a, &x, GST_MAP_READ);
  gst_buffer_map(b, &y, GST_MAP_READ);
  size_t count = x.size == y.size ? 0 : x.size;
  for (gsize i = 0; i < x.size && i < y.size; ++i) count += x.data[i] != y.data[i];
  gst_buffer_unmap(a, &x);
  gst_buffer_unmap(b, &y);
  return count;
}

TEST(OverlayElement, WritesToNoFrameThatSomebodyElseHolds) {
  ElementHarness h("device=none overlay=points");
  h.set_caps(make_caps("I420", 323, 241));
  for (int n = 0; n < 3; ++n) {
    GstBuffer* frame = make_frame(h.info(), 3.0 * n, 0, 13);
    GstBuffer* before = gst_buffer_copy_deep(frame);
    GstBuffer* out = h.pass(gst_buffer_ref(frame), static_cast<GstClockTime>(n) * kFrame);
    EXPECT_NE(out, frame);
    EXPECT_EQ(differences(frame, before), 0u);
    // Nothing is known of the first one.
    EXPECT_EQ(differences(out, before) > 0, n > 0);
    gst_buffer_unref(before);
    gst_buffer_unref(out);
    gst_buffer_unref(frame);
  }
  // What is drawn is not measured again.
  EXPECT_NEAR(h.motions()[2].velocity_x, 75, 2.5);
}

TEST(OverlayElement, CanBeTurnedOnAndOffWhilePlaying) {
  ElementHarness h("device=none");
  h.set_caps(make_caps("NV12", 320, 240));
  for (int n = 0; n < 9; ++n) {
    const bool on = n / 3 == 1;
    if (n % 3 == 0)
      g_object_set(h.element(), "overlay",
                   on ? DisplayProperties::Overlay::kPoints : DisplayProperties::Overlay::kNone,
                   nullptr);
    GstBuffer* frame = make_frame(h.info(), 2.0 * n, 0);
    GstBuffer* before = gst_buffer_copy_deep(frame);
    GstBuffer* out = h.pass(frame, static_cast<GstClockTime>(n) * kFrame);
    EXPECT_EQ(differences(out, before) > 0, on) << "frame " << n;
    gst_buffer_unref(before);
    gst_buffer_unref(out);
  }
}

TEST(OverlayElement, DrawsWithinTheVisiblePart) {
  ElementHarness h("device=none overlay=points");
  h.set_caps(make_caps("GRAY8", 640, 480));
  for (int n = 0; n < 2; ++n) {
    GstBuffer* frame = make_frame(h.info(), 0, 0);
    GstBuffer* before = gst_buffer_copy_deep(frame);
    GstVideoCropMeta* crop = gst_buffer_add_video_crop_meta(frame);
    crop->x = 200;
    crop->y = 100;
    crop->width = 300;
    crop->height = 200;
    GstBuffer* out = h.pass(frame, static_cast<GstClockTime>(n) * kFrame);
    GstMapInfo a, b;
    gst_buffer_map(out, &a, GST_MAP_READ);
    gst_buffer_map(before, &b, GST_MAP_READ);
    int inside = 0, outside = 0;
    for (int y = 0; y < 480; ++y) {
      for (int x = 0; x < 640; ++x) {
        if (a.data[y * 640 + x] == b.data[y * 640 + x]) continue;
        ++(x >= 200 && x < 500 && y >= 100 && y < 300 ? inside : outside);
      }
    }
    EXPECT_EQ(outside, 0);
    EXPECT_EQ(inside > 20, n == 1) << inside;
    gst_buffer_unmap(out, &a);
    gst_buffer_unmap(before, &b);
    gst_buffer_unref(before);
    gst_buffer_unref(out);
  }
}

using TouchedElement = SimulatedElement;

TEST_F(TouchedElement, ShowsTheFingerOnlyWhileThePictureIsTouched) {
  for (const bool touching : {false, true}) {
    open(touching ? "device=sim overlay=points touch=luma" : "device=sim overlay=points touch=off");
    tick(kOpened_ms);
    GstBuffer* out = h->pass(make_picture(h->info(), [](int, int) { return 20; }), 0);
    GstMapInfo map;
    gst_buffer_map(out, &map, GST_MAP_READ);
    // A ring of 5.5 px, 1.4 px thick, about the middle, where a hand holds the simulated grip.
    EXPECT_EQ(map.data[120 * 320 + 164] > 100, touching) << "white, with soft edges";
    EXPECT_EQ(map.data[120 * 320 + 160], 20) << "within the ring";
    gst_buffer_unmap(out, &map);
    gst_buffer_unref(out);
  }
}

}  // namespace
}  // namespace spidar::test::overlay_element_test
