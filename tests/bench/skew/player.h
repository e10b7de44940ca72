// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A pipeline with a spidarmotion that plays a scenario.
#pragma once

#include <cstdint>
#include <string>

#include <gst/gst.h>

#include "tests/bench/skew/screen.h"

namespace spidar::bench {

/// A way to play a video.
struct Scenario {
  const char* what;    ///< for the table
  const char* player;  ///< that plays the clip, or nullptr for a live videotestsrc
  double rate = 1;
  int seeks = 0;        ///< before what is measured
  bool drifts = false;  ///< the pipeline's clock runs kDrift_ppm too fast
};

constexpr int kDrift_ppm = 300;

/// Every member throws std::runtime_error when the pipeline fails or ends too early.
class Player {
 public:
  /// `haptic_trace`: property of spidarmotion.
  Player(const Scenario& scenario, const std::string& clip, const std::string& haptic_trace,
         OnShown on_shown);
  ~Player();
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  /// Plays, after the seeks if there are any. CLOCK_MONOTONIC at which nothing of before was on
  /// its way any more, and no frame of after had been shown.
  int64_t start();

  /// Returns after so long.
  void play_for(double seconds);

  /// To NULL: trace and screen are done.
  void stop();

  /// Frames that the screen dropped for being late.
  uint64_t dropped() const;
  /// What spidarmotion got of the real-time priority that it asks for.
  std::string scheduling() const;

 private:
  GstElement* make_player(const std::string& clip);
  GstElement* make_live();
  void set_state(GstState state);
  void await_state();
  void seek(GstClockTime position);
  void take_messages(GstClockTime timeout);

  const Scenario scenario_;
  GstElement* filter_;
  GstElement* screen_;
  GstElement* pipeline_;
  GstBus* bus_;
};

}  // namespace spidar::bench
