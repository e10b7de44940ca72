// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A film whose force is that of a haptic track is shown like one that is analysed.
#include <gst-spidar/gstspidarmotionmeta.h>

#include "core/track/track_format.h"
#include "tests/support/element_harness.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"
#include "tests/support/wav_track.h"

namespace spidar::test::track_shown_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
constexpr int kFrames = 4;
/// 1.5 N to the right, in fractions of 10 N.
constexpr float kFraction = 0.15F;
/// Of a float.
constexpr double kTolerance_N = 1e-6;

class TrackShown : public testing::Test {
 protected:
  void SetUp() override {
    path = (folder.path / "film.haptic.wav").string();
    write_track(path, kFrames * 40, [](double) { return TrackSample{kFraction, 0, 0, 0, 0, 0}; });
  }
  TemporaryFolder folder;
  std::string path;
};

TEST_F(TrackShown, EachFrameHasAMessageWithTheForceAndTheTrack) {
  ElementHarness h("device=none track=" + path);
  h.set_caps(make_caps("GRAY8", 320, 240));
  for (int i = 0; i < kFrames; ++i) h.push_moved(0, 0, static_cast<GstClockTime>(i) * kFrame);
  ASSERT_EQ(h.motions().size(), static_cast<size_t>(kFrames));
  for (const MotionMessage& message : h.motions()) {
    EXPECT_EQ(message.track, path);
    EXPECT_NEAR(message.wrench.force_N.x(), 10 * kFraction, kTolerance_N);
    EXPECT_EQ(message.no_force, "none");
  }
  EXPECT_EQ(h.motions()[2].running_time, 2 * kFrame);
  EXPECT_EQ(h.stats_field("track"), path);
  ElementHarness analysed;
  analysed.set_caps(make_caps("GRAY8", 320, 240));
  analysed.push_moved(0, 0, 0);
  EXPECT_EQ(analysed.motions().at(0).track, "");
}

TEST_F(TrackShown, TheMetaHasItsForce) {
  ElementHarness h("device=none attach-meta=true track=" + path);
  h.set_caps(make_caps("GRAY8", 320, 240));
  GstBuffer* const frame = h.pass(make_frame(h.info(), 0, 0), 0);
  GstSpidarFrameMotion motion{};
  ASSERT_TRUE(gst_buffer_get_spidar_motion(frame, &motion));
  EXPECT_NEAR(motion.force_x, 10 * kFraction, kTolerance_N);
  EXPECT_GT(motion.interval, 0u) << "for spidarextract, which takes it for rest otherwise";
  gst_buffer_unref(frame);
}

/// Where the arrow lies on a grey picture of 320 × 240, and the curve.
TEST_F(TrackShown, TheOverlayDrawsArrowAndCurve) {
  ElementHarness h("device=none overlay=curve max-force=2 track=" + path);
  h.set_caps(make_caps("GRAY8", 320, 240));
  GstBuffer* out = nullptr;
  for (int i = 0; i < kFrames; ++i) {
    gst_clear_buffer(&out);
    out = h.pass(make_picture(h.info(), [](int, int) { return 100; }),
                 static_cast<GstClockTime>(i) * kFrame);
  }
  GstMapInfo map;
  gst_buffer_map(out, &map, GST_MAP_READ);
  const auto has_white = [&](int x, int y, int width, int height) {
    for (int row = y; row < y + height; ++row) {
      const guint8* const begin = map.data + row * 320 + x;
      if (std::any_of(begin, begin + width, [](guint8 level) { return level > 230; })) return true;
    }
    return false;
  };
  // max-force is a fifth of the height, so that 1.5 N of 2 N are 36 px to the right of the middle.
  EXPECT_TRUE(has_white(162, 118, 30, 5)) << "the arrow";
  EXPECT_FALSE(has_white(120, 118, 36, 5)) << "only to the right";
  const guint8* const low = map.data + 235 * 320;
  EXPECT_LT(*std::min_element(low, low + 320), 100) << "the ground of the curve is darker";
  gst_buffer_unmap(out, &map);
  gst_buffer_unref(out);
}

}  // namespace
}  // namespace spidar::test::track_shown_test
