// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Plays a film and tells its forces.
#pragma once

#include <array>
#include <deque>
#include <string>

#include <gst/gst.h>

#include "apps/play/pipeline.h"
#include "apps/player/keys.h"

class Player {
 public:
  /// `uri` of the film. With `headless`, or without a display, the film is neither seen nor heard
  /// but keeps its timing. Throws std::runtime_error when an element is missing.
  Player(const std::string& uri, bool headless);
  ~Player();
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  void play();
  /// Returns when the seek is done and the film is at its new place.
  void act(const Action& action);
  /// Call this at the end of the film: starts again from the beginning, or returns false.
  bool again();

  /// Takes a message of the element about an analysed frame; ignores others.
  void note(const GstStructure* message);
  /// Force of the frame on the screen, N: x right, y up, z towards the viewer; zero in a pause and
  /// while the force is off.
  std::array<double, 3> force_N() const;
  double max_force_N() const;

  /// "0:12.48 / 3:45.00, 1x, playing, force on, delay 0 ms"
  std::string status() const;
  /// Why the film is not shown; empty when it is.
  const std::string& why_no_screen() const { return screen_.why_none; }
  GstElement* pipeline() const { return playbin_; }
  GstBus* bus() const { return bus_; }

 private:
  void seek(gint64 position);
  void settle();
  gint64 position() const;

  /// Frames that were analysed and have not been replaced on the screen.
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
