// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A film with its forces.
#pragma once

#include <array>
#include <deque>
#include <string>

#include <gst/gst.h>

#include "examples/play/pipeline.h"
#include "examples/player/keys.h"

class Player {
 public:
  /// `uri` of the film. `headless`, or where there is no display: neither seen nor heard, but in
  /// time. Throws std::runtime_error when an element is missing.
  Player(const std::string& uri, bool headless);
  ~Player();
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  void play();
  /// Returns when it is done: the film is at its new place.
  void act(const Action& action);
  /// The end of the film was reached: from the beginning again, or false.
  bool again();

  /// A message of the element about a frame that it has analysed; others are left alone.
  void note(const GstStructure* message);
  /// Of the frame on the screen, N: x right, y up, z towards the viewer; zero in a pause and while
  /// the force is off.
  std::array<double, 3> force_N() const;
  double max_force_N() const;

  /// "0:12.48 / 3:45.00, 1x, playing, force on, delay 0 ms"
  std::string status() const;
  /// Empty when the film is seen.
  const std::string& why_no_screen() const { return screen_.why_none; }
  GstElement* pipeline() const { return playbin_; }
  GstBus* bus() const { return bus_; }

 private:
  void seek(gint64 position);
  void settle();
  gint64 position() const;

  /// Of frames that were analysed and not yet followed by another one on the screen.
  struct FrameForce {
    GstClockTime stream_time = 0;
    std::array<double, 3> force_N{};
  };
  mutable std::deque<FrameForce> forces_;
  GstElement* motion_;
  Screen screen_;
  GstElement* playbin_;
  GstBus* bus_;
  bool paused_ = false;
  bool loop_ = false;
  bool force_ = true;
  size_t speed_;
  int delay_ms_ = 0;
};
