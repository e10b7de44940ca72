// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Films under spidar-feel with frames of sizes that spidarmotion does not accept.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/felt_ticks.h"
#include "tests/support/shell.h"
#include "tests/support/temporary_folder.h"

namespace spidar::test::feel_sizes_test {
namespace {

using Size = std::pair<int, int>;

class FeelSizes : public testing::Test {
 protected:
  /// A moving picture in several sizes, one after the other, at 25 frames/s. The file says 320x240,
  /// whatever the size: muxers accept neither a new size nor one below 16.
  void make_film(const std::vector<Size>& sizes, int frames_each) {
    std::string line = "gst-launch-1.0 -q concat name=all ! webmmux ! filesink location=" + film_;
    for (const auto& [width, height] : sizes)
      line += " videotestsrc pattern=smpte horizontal-speed=2 num-buffers=" +
              std::to_string(frames_each) + " ! video/x-raw,width=" + std::to_string(width) +
              ",height=" + std::to_string(height) +
              ",framerate=25/1 ! vp8enc deadline=1 cpu-used=8 ! capssetter replace=true "
              "caps='video/x-vp8,width=320,height=240,framerate=25/1,profile=(string)0' ! all.";
    const CommandResult made = run(line);
    ASSERT_EQ(made.status, 0) << made.text;
  }

  CommandResult feel(const std::string& playbin) const {
    return run(SPIDAR_FEEL " device=sim motion=mean haptic-trace=" + trace_ +
               " -- " FEEL_PLAYER " " + playbin + " " + film_ + " play end stop");
  }

  TemporaryFolder folder_;
  const std::string film_ = (folder_.path / "film.webm").string();
  const std::string trace_ = (folder_.path / "trace.csv").string();
};

/// The largest force of each section in which spidarmotion plays.
std::vector<double> forces_while_playing(const std::vector<Tick>& ticks) {
  std::vector<double> forces;
  bool playing = false;
  for (const Tick& tick : ticks) {
    if (tick.playing && !playing) forces.push_back(0);
    if (tick.playing) forces.back() = std::max(forces.back(), tick.force_N);
    playing = tick.playing;
  }
  return forces;
}

TEST_F(FeelSizes, AFilmThatIsTooSmallOrTooLargePlays) {
  for (const auto& [width, height] : {Size{8, 8}, Size{8208, 16}}) {
    // They last two seconds, so that the device is open before the last of them.
    make_film({{width, height}}, 50);
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    const CommandResult outcome = feel("playbin3");
    EXPECT_EQ(outcome.status, 0) << outcome.text;
    EXPECT_EQ(outcome.text.find("spidar-feel: frames of " + size + " pixels are not felt; "), 0u)
        << outcome.text;
    EXPECT_NE(outcome.text.find("\n50 frames, "), std::string::npos) << outcome.text;
    EXPECT_EQ(largest_N(read_trace(trace_)), 0);
  }
}

TEST_F(FeelSizes, WhatFitsIsFeltBeforeAndAfterFramesThatDoNot) {
  make_film({{320, 240}, {8, 8}, {320, 240}}, 25);
  const CommandResult outcome = feel("playbin");
  EXPECT_EQ(outcome.status, 0) << outcome.text;
  EXPECT_EQ(outcome.text.find("spidar-feel: frames of 8x8 pixels are not felt; "), 0u)
      << outcome.text;
  EXPECT_NE(outcome.text.find("\n75 frames, "), std::string::npos) << outcome.text;
  const std::vector<double> forces = forces_while_playing(read_trace(trace_));
  ASSERT_GE(forces.size(), 2u);
  EXPECT_GT(forces.front(), 0.1);
  EXPECT_GT(forces.back(), 0.1);
}

}  // namespace
}  // namespace spidar::test::feel_sizes_test
