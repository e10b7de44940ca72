// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An element on the simulated device that is asked why nothing is felt.
#pragma once

#include "tests/element/simulated_element.h"

namespace spidar::test {

constexpr int kWidth = 320, kHeight = 240;
constexpr int kFrame_ms = 40;
constexpr int kFrames = 30;  // more than the second that is evaluated

/// Grey levels of a frame: by column, row and number of the frame.
using GreyLevels = std::function<int(int, int, int)>;

class NoForceReasonTest : public SimulatedElement {
 protected:
  void play() {
    SimulatedElement::play();
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
      return make_picture(h->info(), [&](int x, int y) { return grey(x, y, n); });
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

  std::string stats_field(const char* name) { return h->stats_field(name); }
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
};

}  // namespace spidar::test
