// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Contents of films: a flash, a dissolve, rotated pictures. On a test clock.
#include <gst/app/gstappsrc.h>

#include "tests/pipelines/shown_motion.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::pictures_test {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

/// Grey level, 0 … 255, of pixel (x, y) in frame n.
using Picture = std::function<double(int n, int x, int y)>;

/// Plays a film of `frames` at 25 frames/s. The wrench that is wanted at each frame.
std::vector<Wrench> play_film(const std::string& motion, int frames, const Picture& picture) {
  SteppedPipeline pipeline(
      "appsrc name=source format=time max-bytes=0 caps=video/x-raw,format=GRAY8,width=" +
      std::to_string(kWidth) + ",height=" + std::to_string(kHeight) + ",framerate=25/1 " + motion +
      kSink);
  GstElement* source = gst_bin_get_by_name(GST_BIN(pipeline.pipeline()), "source");
  for (int n = 0; n < frames; ++n) {
    std::vector<guint8> pixels;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        pixels.push_back(
            static_cast<guint8>(std::lround(std::clamp(picture(n, x, y), 0.0, 255.0))));
      }
    }
    GstBuffer* frame = gst_buffer_new_memdup(pixels.data(), pixels.size());
    GST_BUFFER_PTS(frame) = static_cast<GstClockTime>(n) * kFrame;
    GST_BUFFER_DURATION(frame) = kFrame;
    gst_app_src_push_buffer(GST_APP_SRC(source), frame);
  }
  gst_app_src_end_of_stream(GST_APP_SRC(source));
  gst_object_unref(source);
  pipeline.set_state(GST_STATE_PLAYING);
  std::vector<Wrench> wanted;
  for (int n = 0; n < frames; ++n) {
    const TickRecord tick = pipeline.step();
    expect_wrench_of_frame(pipeline, tick);
    wanted.push_back(tick.wanted);
  }
  return wanted;
}

void expect_nothing_felt(const std::string& motion, int frames, const Picture& picture) {
  const std::vector<Wrench> wanted = play_film(motion, frames, picture);
  for (size_t n = 0; n < wanted.size(); ++n) EXPECT_EQ(wanted[n].stacked().norm(), 0) << n;
}

const Texture kStill(1, 7.0);
const Texture kOther(2, 7.0);

TEST(Pictures, AFlashIsNoMotion) {
  for (const std::string& motion : {std::string("! spidarmotion name=motion "), kMotion}) {
    SCOPED_TRACE(motion);
    expect_nothing_felt(motion, 10,
                        [](int n, int x, int y) { return n == 5 ? 255 : kStill.at(x, y); });
  }
}

TEST(Pictures, ADissolveIsNoObject) {
  // Of the mean of all points no such thing can be said: what fades in is not told from what moves.
  expect_nothing_felt("! spidarmotion name=motion ", 20, [](int n, int x, int y) {
    const double fraction = std::clamp(n - 5, 0, 10) / 10.0;
    return (1 - fraction) * kStill.at(x, y) + fraction * kOther.at(x, y);
  });
}

const std::string kSquareBall =
    "videotestsrc pattern=ball ! video/x-raw,format=GRAY8,width=240,height=240,framerate=25/1 ";

/// As on the screen: motion to the right becomes downward motion; y of forces points up.
Eigen::Vector3d turned_clockwise(const Eigen::Vector3d& v) {
  return {v.y(), -v.x(), v.z()};
}

TEST(Pictures, TurnedByAnElementBeforeOrAfter) {
  SteppedPipeline usual(kSquareBall + kMotion + kSink);
  usual.set_state(GST_STATE_PLAYING);
  const std::vector<Eigen::Vector3d> usual_px_s = play(usual, 10);
  const auto expect_turned = [&](const std::string& launch, bool turned) {
    SCOPED_TRACE(launch);
    SteppedPipeline pipeline(launch);
    pipeline.set_state(GST_STATE_PLAYING);
    const std::vector<Eigen::Vector3d> felt_px_s = play(pipeline, 10);
    for (size_t n = 1; n < 10; ++n) {
      const Eigen::Vector3d expected = turned ? turned_clockwise(usual_px_s[n]) : usual_px_s[n];
      EXPECT_LT((felt_px_s[n] - expected).norm(), kTolerance_px_s) << n;
      EXPECT_GT(felt_px_s[n].norm(), kMoves_px_s) << n;
    }
  };
  const std::string tag = "! taginject tags=image-orientation=rotate-90 ";
  expect_turned(kSquareBall + "! videoflip video-direction=90r " + kMotion + kSink, true);
  // Turned once, whether a filter follows the tag or leaves that to the sink.
  for (const char* filter :
       {"! videoflip video-direction=auto ", "! videoflip method=automatic ",
        "! videoflip video-direction=auto ! queue ! capsfilter ! videoconvert ",
        "! flip. bin.( videoflip name=flip video-direction=auto ! queue name=out ) out. ",
        "! videoflip video-direction=identity ", ""}) {
    expect_turned(kSquareBall + tag + filter + kMotion + kSink, true);
  }
  // The element does not know what happens after it.
  expect_turned(kSquareBall + kMotion + "! videoflip video-direction=90r " + kSink, false);
}

}  // namespace
}  // namespace spidar::test::pictures_test
