// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Why nothing is felt: each reason in the message, in the stats and in the trace.
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "core/analysis/force_limit.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/simulation/simulated_device.h"
#include "tests/support/element_harness.h"
#include "tests/support/video_frames.h"

namespace spidar::test {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr int kFrame_ms = 40;
constexpr int kFrames = 30;  // more than the second that is evaluated
constexpr int kOpened_ms = 300;

int64_t read_time(void* time) {
  return *static_cast<int64_t*>(time);
}

/// Grey levels of a frame: by column, row and number of the frame.
using Picture = std::function<int(int, int, int)>;

class ForceLimitTest : public testing::Test {
 protected:
  void open(const std::string& properties) {
    h = std::make_unique<ElementHarness>(properties, read_time, &time_ns);
    h->set_caps(make_caps("GRAY8", kWidth, kHeight));
  }

  HapticLoop& loop() { return h->engine().output().session()->loop(); }
  SimulatedDevice& device() {
    return dynamic_cast<SimulatedDevice&>(h->engine().output().session()->device());
  }

  void tick(int count) {
    for (int i = 0; i < count; ++i) {
      time_ns += kTick_ns;
      h->tick(time_ns);
    }
  }

  /// Starts running time, with a device that runs.
  void play() {
    tick(kOpened_ms);
    PlaybackClock clock;
    clock.playing = true;
    clock.monotonic_ns = time_ns;
    loop().set_playback_clock(clock);
    tick(1);
  }

  /// Each frame is analysed two before it is shown.
  void show(int count, const std::function<GstBuffer*(int)>& frame, int interval_ms = kFrame_ms) {
    for (int i = 0; i < count; ++i, ++frames) {
      h->push(frame(frames), static_cast<GstClockTime>(frames * interval_ms) * GST_MSECOND);
      if (frames >= 2 && h->engine().output().session()) tick(interval_ms);
    }
  }
  void show_moved(int count, double px_a_frame) {
    show(count, [&](int n) { return make_frame(h->info(), px_a_frame * n, 0); });
  }
  void show_picture(const Picture& grey, int interval_ms = kFrame_ms) {
    const auto frame = [&](int n) {
      GstBuffer* const buffer = gst_buffer_new_allocate(nullptr, kWidth * kHeight, nullptr);
      GstMapInfo map;
      gst_buffer_map(buffer, &map, GST_MAP_WRITE);
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          map.data[y * kWidth + x] = static_cast<guint8>(grey(x, y, n));
        }
      }
      gst_buffer_unmap(buffer, &map);
      return buffer;
    };
    show(kFrames, frame, interval_ms);
  }
  /// The same texture with other noise of one grey level in each frame.
  void show_noise(int interval_ms = kFrame_ms) {
    std::mt19937 random(7);
    show_picture(
        [&](int x, int y, int) {
          return static_cast<int>(texture(x, y)) + static_cast<int>(random() >> 31);
        },
        interval_ms);
  }

  std::string stats_field(const char* name) {
    GstStructure* stats = nullptr;
    g_object_get(h->element(), "stats", &stats, nullptr);
    const char* const text = gst_structure_get_string(stats, name);
    const std::string result = text ? text : "";
    gst_structure_free(stats);
    return result;
  }
  std::string message_limit() { return h->motions().back().limit; }

  void expect_everywhere(const std::string& limit) {
    EXPECT_EQ(stats_field("limit"), limit);
    EXPECT_EQ(message_limit(), limit);
    EXPECT_FALSE(stats_field("limit-reason").empty());
    EXPECT_EQ(h->motions().back().limit_reason, stats_field("limit-reason"));
  }

  int64_t time_ns = 1'000'000'000;
  int frames = 0;
  std::unique_ptr<ElementHarness> h;
};

TEST_F(ForceLimitTest, IsNoneWhileTheForceIsFelt) {
  open("device=sim");
  play();
  show_moved(kFrames, 2);
  EXPECT_EQ(stats_field("limit"), "none");
  EXPECT_EQ(message_limit(), "none");
  EXPECT_EQ(stats_field("limit-reason"), "");
  EXPECT_EQ(h->motions().back().limit_reason, "");
}

TEST_F(ForceLimitTest, OnlyTheCameraMoves) {
  open("device=sim motion=object");
  play();
  show_moved(kFrames, 2);
  expect_everywhere("camera-only");
}

TEST_F(ForceLimitTest, TheCameraIsFeltWhereThatWasAskedFor) {
  open("device=sim motion=camera");
  play();
  show_moved(kFrames, 2);
  EXPECT_EQ(stats_field("limit"), "none");
}

TEST_F(ForceLimitTest, NothingMoves) {
  open("device=sim motion=object");
  play();
  show_noise();
  expect_everywhere("nothing-moves");
}

TEST_F(ForceLimitTest, AllFramesShowTheSamePicture) {
  for (const char* motion : {"motion=object", "motion=mean"}) {
    SCOPED_TRACE(motion);
    frames = 0;
    open(std::string("device=sim ") + motion);
    play();
    show_moved(kFrames, 0);
    expect_everywhere("repeated-frames");
    EXPECT_TRUE(h->motions().back().repeated);
    EXPECT_FALSE(h->motions().front().repeated);
  }
}

TEST_F(ForceLimitTest, FramesWithoutAPictureRepeatTheOneBefore) {
  open("device=sim motion=object");
  play();
  show_moved(1, 0);
  show(kFrames, [&](int) {
    GstBuffer* const frame = make_frame(h->info(), 50, 0);  // must not be looked at
    GST_BUFFER_FLAG_SET(frame, GST_BUFFER_FLAG_GAP);
    return frame;
  });
  EXPECT_EQ(stats_field("limit"), "repeated-frames");
}

TEST_F(ForceLimitTest, ThePictureHasTooLittleTexture) {
  for (const char* motion : {"motion=object", "motion=mean"}) {
    SCOPED_TRACE(motion);
    frames = 0;
    open(std::string("device=sim ") + motion);
    play();
    show_picture([](int, int, int n) { return 100 + n; });
    expect_everywhere("too-few-points");
  }
}

TEST_F(ForceLimitTest, PicturesComeTooSeldom) {
  open("device=sim motion=object");
  play();
  show_noise(400);
  expect_everywhere("few-pictures");
}

TEST_F(ForceLimitTest, TheForceIsTooWeakToFeel) {
  open("device=sim alpha=0.0001");  // eq. 15: 0.01 N at 50 px/s
  play();
  show_moved(kFrames, 2);
  expect_everywhere("too-weak");
}

TEST_F(ForceLimitTest, OneFeltFrameInTheLastSecondIsFelt) {
  open("device=sim motion=object filter-min-cutoff=1");
  play();
  show_moved(kFrames, 0);
  EXPECT_EQ(stats_field("limit"), "repeated-frames");
  g_object_set(h->element(), "motion", 3, nullptr);  // camera
  show(5, [&](int n) { return make_frame(h->info(), 4.0 * (n - kFrames), 0); });
  EXPECT_EQ(stats_field("limit"), "none");
  show(10, [&](int) { return make_frame(h->info(), 4.0 * 4, 0); });
  EXPECT_EQ(stats_field("limit"), "none") << "0.4 s later";
  show(30, [&](int) { return make_frame(h->info(), 4.0 * 4, 0); });
  EXPECT_EQ(stats_field("limit"), "repeated-frames") << "1.6 s later";
}

TEST_F(ForceLimitTest, Muted) {
  open("device=sim");
  play();
  show_moved(kFrames, 2);
  EXPECT_EQ(stats_field("limit"), "none");
  g_object_set(h->element(), "mute", TRUE, nullptr);
  show_moved(1, 2);
  expect_everywhere("muted");
  g_object_set(h->element(), "mute", FALSE, nullptr);
  show_moved(4, 2);
  EXPECT_EQ(stats_field("limit"), "none");
}

TEST_F(ForceLimitTest, NotPlaying) {
  open("device=sim");
  tick(kOpened_ms);
  show_moved(3, 2);
  expect_everywhere("not-playing");
}

TEST_F(ForceLimitTest, TheDeviceIsNotRunningYet) {
  open("device=sim");
  tick(kOpened_ms / 3);
  show_moved(2, 2);
  expect_everywhere("device-starting");
}

TEST_F(ForceLimitTest, TheDeviceDoesNotAnswer) {
  open("device=sim");
  play();
  show_moved(kFrames, 2);
  device().set_fault(ExchangeStatus::kLost);
  show_moved(2, 2);
  expect_everywhere("device-lost");
}

TEST_F(ForceLimitTest, ThePlaceOfTheGripIsNotKnown) {
  open("device=sim");
  play();
  show_moved(kFrames, 2);
  // String lengths that fit no pose, by centimetres.
  for (int string = 0; string < 8; ++string) {
    device().set_count_error(string, string % 3 == 0 ? 3000 : -1000 * string);
  }
  show_moved(5, 2);  // 200 ms
  expect_everywhere("grip-unknown");
}

TEST_F(ForceLimitTest, TheVideoHasEnded) {
  open("device=sim motion=object");
  play();
  show_moved(kFrames, 2);
  EXPECT_EQ(stats_field("limit"), "camera-only");
  tick(1200);
  EXPECT_EQ(stats_field("limit"), "no-frames");
}

TEST_F(ForceLimitTest, TheFirstFrameHasNothingToBeComparedWith) {
  open("device=sim");
  play();
  show_moved(1, 2);
  expect_everywhere("nothing-to-compare");
}

TEST_F(ForceLimitTest, FramesThatComeTooLate) {
  open("device=sim");
  play();
  tick(2000);
  // Each is known a second after it should have been shown.
  for (int n = 0; n < kFrames; ++n) {
    h->push_moved(2.0 * n, 0, static_cast<GstClockTime>(1000 + n * kFrame_ms) * GST_MSECOND);
    tick(kFrame_ms);
  }
  EXPECT_EQ(message_limit(), "late");
}

/// Grey levels below 128 are behind the grip, which a hand holds in the middle.
GstBuffer* level_frame(const GstVideoInfo& info, int grey) {
  GstBuffer* const buffer = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info), nullptr);
  gst_buffer_memset(buffer, 0, static_cast<guint8>(grey), GST_VIDEO_INFO_SIZE(&info));
  return buffer;
}

// The store is empty from the beginning.
TEST_F(ForceLimitTest, TheFilmShakesTheHand) {
  const auto drain = [&] { loop().vibration().restore(time_ns + 24 * 3600 * 1'000'000'000LL); };
  // A strobe: the whole picture jumps to and fro.
  open("device=sim motion=camera filter-min-cutoff=0");
  play();
  drain();
  const auto strobe = [&](int n) { return make_frame(h->info(), n % 2 == 0 ? 0 : 4, 0); };
  show(kFrames, strobe);
  expect_everywhere("vibration");
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

TEST_F(ForceLimitTest, TouchingTheReasonsAreThoseOfTheContact) {
  open("device=sim touch=luma");
  play();
  show(kFrames, [&](int) { return level_frame(h->info(), 20); });
  expect_everywhere("not-touching");
  show(kFrames, [&](int) { return level_frame(h->info(), 235); });
  EXPECT_EQ(stats_field("limit"), "none") << "a picture that never moves is felt";
  g_object_set(h->element(), "max-force", kFeltForce_N / 2, nullptr);
  show(kFrames, [&](int) { return level_frame(h->info(), 235); });
  expect_everywhere("light-touch");
  g_object_set(h->element(), "max-force", 3.0, nullptr);
  Pose hand;
  hand.position_m.z() = 0.02;
  device().set_hand(hand);
  show(15, [&](int) { return level_frame(h->info(), 235); });
  EXPECT_EQ(stats_field("limit"), "none") << "felt until 0.6 s ago at most";
  show(kFrames, [&](int) { return level_frame(h->info(), 235); });
  expect_everywhere("not-touching");
  gst_harness_push_event(h->harness(), gst_event_new_eos());
  tick(100);
  EXPECT_EQ(stats_field("limit"), "no-relief") << "the video has ended";
}

TEST_F(ForceLimitTest, TouchingNeedsADeviceAndARelief) {
  open("device=none touch=luma motion=object");
  show_moved(kFrames, 2);
  expect_everywhere("no-device");
  open("device=sim touch=depth");
  frames = 0;
  play();
  show_moved(kFrames, 2);
  expect_everywhere("no-relief");
}

TEST_F(ForceLimitTest, WithoutADeviceTheVideosReasonsComeFirst) {
  open("device=none");
  show_moved(kFrames, 2);
  expect_everywhere("no-device");
  open("device=none motion=object");
  frames = 0;
  show_moved(kFrames, 2);
  expect_everywhere("camera-only");
}

}  // namespace
}  // namespace spidar::test
