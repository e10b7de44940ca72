// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An element on the simulated device that is asked why nothing is felt.
#pragma once

#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/haptic_loop.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test {

constexpr int kWidth = 320, kHeight = 240;
constexpr int kFrame_ms = 40;
constexpr int kFrames = 30;  // more than the second that is evaluated
constexpr int kOpened_ms = 300;

/// Grey levels of a frame: by column, row and number of the frame.
using GreyLevels = std::function<int(int, int, int)>;

class NoForceReasonTest : public testing::Test {
 protected:
  void open(const std::string& properties) {
    h = std::make_unique<ElementHarness>(properties, [this] { return time_ns; });
    h->set_caps(make_caps("GRAY8", kWidth, kHeight));
  }

  HapticLoop& loop() { return h->state().feed.output.session()->loop(); }
  SimulatedDevice& device() { return *h->state().feed.output.simulated(); }

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
      if (frames >= 2 && h->state().feed.output.session()) tick(interval_ms);
    }
  }
  void show_moved(int count, double px_a_frame) {
    show(count, [&](int n) { return make_frame(h->info(), px_a_frame * n, 0); });
  }
  void show_picture(const GreyLevels& grey, int interval_ms = kFrame_ms) {
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
  std::string message_reason() { return h->motions().back().no_force; }

  /// The film's reason, and nothing of the device.
  void expect_everywhere(const std::string& reason) {
    EXPECT_EQ(stats_field("no-force-reason"), reason);
    EXPECT_EQ(message_reason(), reason);
    EXPECT_FALSE(stats_field("no-force-text").empty());
    EXPECT_EQ(h->motions().back().no_force_text, stats_field("no-force-text"));
    EXPECT_EQ(stats_field("device-no-force-reason"), "none");
    EXPECT_EQ(h->motions().back().device_no_force, "none");
  }
  /// Whatever the film shows.
  void expect_of_device(const std::string& reason) {
    EXPECT_EQ(stats_field("device-no-force-reason"), reason);
    EXPECT_EQ(h->motions().back().device_no_force, reason);
    EXPECT_FALSE(stats_field("device-no-force-text").empty());
  }

  int64_t time_ns = 1'000'000'000;
  int frames = 0;
  std::unique_ptr<ElementHarness> h;
};

}  // namespace spidar::test
