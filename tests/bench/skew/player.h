// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A pipeline with a spidarmotion, or with a spidarsink beside the video sink, that plays a
/// scenario.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <gst/gst.h>

#include "tests/bench/skew/camera.h"
#include "tests/bench/skew/scenario.h"
#include "tests/bench/skew/screen.h"

namespace spidar::bench {

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
  GstElement* make_track_player(const std::string& clip);
  void set_state(GstState state);
  void await_state();
  void seek(GstClockTime position);
  void take_messages(GstClockTime timeout);
  void check_clock() const;

  const Scenario scenario_;
  GstElement* filter_;
  GstElement* screen_;
  GstElement* pipeline_;
  GstBus* bus_;
  std::unique_ptr<Camera> camera_;
};

}  // namespace spidar::bench
