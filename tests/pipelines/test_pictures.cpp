// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Contents of films: cuts, fades, still pictures, any frame rate, rotated pictures. On a test
// clock.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gst/app/gstappsrc.h>
#include <gtest/gtest.h>

#include "tests/pipelines/shown_motion.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/texture.h"

namespace spidar::test::pictures_test {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

/// Grey level, 0 … 255, of pixel (x, y) in frame n.
using Picture = std::function<double(int n, int x, int y)>;

/// The defaults, and the settings of the paper.
const std::vector<std::string> kSettings{"! spidarmotion name=motion ", kMotion};

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

void expect_nothing_felt(int frames, const Picture& picture,
                         const std::vector<std::string>& settings = kSettings) {
  for (const std::string& motion : settings) {
    SCOPED_TRACE(motion);
    const std::vector<Wrench> wanted = play_film(motion, frames, picture);
    for (size_t n = 0; n < wanted.size(); ++n) EXPECT_EQ(wanted[n].stacked().norm(), 0) << n;
  }
}

const Texture kStill(1, 7.0);
const Texture kOther(2, 7.0);
/// Of one measurement: a tenth of a pixel (see test_frames.cpp), on 480 lines, over 40 ms.
constexpr double kOne_px_s = 0.1 * 480 / kHeight / 0.04;

TEST(Pictures, ACutIsNoKick) {
  // Both scenes move to the right, the second one half as fast. The force before the cut and after
  // it points there, too, so that no tick between the frames can point elsewhere.
  const std::vector<Wrench> wanted = play_film(kMotion, 20, [](int n, int x, int y) {
    return n < 10 ? kStill.at(x - 2 * n, y) : kOther.at(x - (n - 10), y);
  });
  for (size_t n = 0; n < 20; ++n) {
    const Eigen::Vector3d felt_px_s = velocity_px_s(wanted[n].force_N);
    if (n == 0 || n == 10) {
      EXPECT_EQ(felt_px_s.norm(), 0) << n;
    } else {
      const double shown_px_s = (n < 10 ? 2 : 1) * 25 * 480 / kHeight;
      EXPECT_LT((felt_px_s - Eigen::Vector3d(shown_px_s, 0, 0)).norm(), kOne_px_s) << n;
    }
  }
}

TEST(Pictures, AFadeIsNoMotion) {
  for (const double to : {0.0, 255.0, 128.0}) {
    SCOPED_TRACE(to);
    // Out in ten frames, and in again. The paper's points, whose search assumes constant
    // brightness, move by some hundredths of a pixel.
    expect_nothing_felt(24,
                        [&](int n, int x, int y) {
                          const double left = std::clamp(std::abs(n - 12) - 1, 0, 10) / 10.0;
                          return to + left * (kStill.at(x, y) - to);
                        },
                        {kSettings[0]});
  }
}

TEST(Pictures, AFlashIsNoMotion) {
  expect_nothing_felt(10, [&](int n, int x, int y) { return n == 5 ? 255 : kStill.at(x, y); });
}

TEST(Pictures, ADissolveIsNoObject) {
  // Of the mean of all points no such thing can be said: what fades in is not told from what moves.
  const std::vector<Wrench> wanted = play_film(kSettings[0], 20, [](int n, int x, int y) {
    const double fraction = std::clamp(n - 5, 0, 10) / 10.0;
    return (1 - fraction) * kStill.at(x, y) + fraction * kOther.at(x, y);
  });
  for (size_t n = 0; n < wanted.size(); ++n) EXPECT_EQ(wanted[n].stacked().norm(), 0) << n;
}

TEST(Pictures, SubtitlesAreNoMotion) {
  const TemporaryFolder folder;
  const std::string subtitles = (folder.path / "film.srt").string();
  std::ofstream(subtitles) << "1\n00:00:00,200 --> 00:00:00,500\nSome words\n\n"
                              "2\n00:00:00,500 --> 00:00:00,800\nand others\n\n"
                              "3\n00:00:01,500 --> 00:00:01,800\nand more\n\n";
  // A picture that says where it is: in one that repeats itself, words may look like its next
  // square.
  SteppedPipeline pipeline(
      "textoverlay name=text font-desc=\"Sans, 40\" " + kSettings[0] + kSink +
      " videotestsrc pattern=smpte75 ! video/x-raw,format=I420,width=320,height=240,"
      "framerate=25/1 ! text. filesrc location=" +
      subtitles + " ! subparse ! text.");
  pipeline.set_state(GST_STATE_PLAYING);
  for (int n = 0; n < 25; ++n) {
    const TickRecord tick = pipeline.step();
    expect_wrench_of_frame(pipeline, tick);
    EXPECT_EQ(tick.wanted.stacked().norm(), 0) << n;
  }
}

std::string ball(int frames_per_s) {
  return "videotestsrc pattern=ball ! video/x-raw,format=GRAY8,width=240,height=240,framerate=" +
         std::to_string(frames_per_s) + "/1 ";
}

TEST(Pictures, AnyFrameRate) {
  SteppedPipeline usual(ball(25) + kMotion + kSink);
  usual.set_state(GST_STATE_PLAYING);
  const std::vector<Eigen::Vector3d> usual_px_s = play(usual, 100);
  for (const int frames_per_s : {1, 250}) {
    SCOPED_TRACE(frames_per_s);
    SteppedPipeline pipeline(ball(frames_per_s) + kMotion + kSink);
    pipeline.set_state(GST_STATE_PLAYING);
    const std::vector<Eigen::Vector3d> felt_px_s = play(pipeline, 100);
    const double faster = frames_per_s / 25.0;  // as far from frame to frame
    for (size_t n = 0; n < 100; ++n) {
      EXPECT_LT((felt_px_s[n] - faster * usual_px_s[n]).norm(), faster * kTolerance_px_s) << n;
    }
  }
}

/// As on the screen: motion to the right becomes downward motion; y of forces points up.
Eigen::Vector3d turned_clockwise(const Eigen::Vector3d& v) {
  return {v.y(), -v.x(), v.z()};
}

TEST(Pictures, TurnedByAnElementBeforeOrAfter) {
  SteppedPipeline usual(ball(25) + kMotion + kSink);
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
  expect_turned(ball(25) + "! videoflip video-direction=90r " + kMotion + kSink, true);
  // Turned once, whether a filter follows the tag or leaves that to the sink.
  for (const char* filter :
       {"! videoflip video-direction=auto ", "! videoflip method=automatic ",
        "! videoflip video-direction=auto ! queue ! capsfilter ! videoconvert ",
        "! flip. bin.( videoflip name=flip video-direction=auto ! queue name=out ) out. ",
        "! videoflip video-direction=identity ", ""}) {
    expect_turned(ball(25) + tag + filter + kMotion + kSink, true);
  }
  // The element does not know what happens after it.
  expect_turned(ball(25) + kMotion + "! videoflip video-direction=90r " + kSink, false);
}

}  // namespace
}  // namespace spidar::test::pictures_test
