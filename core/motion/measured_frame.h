// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/motion/camera/background.h"
#include "core/motion/image_motion.h"
#include "core/motion/objects/moving_object.h"
#include "core/picture/film_area.h"
#include "core/picture/repeated_picture.h"
#include "core/points/tracker.h"

namespace spidar {

/// What is measured in a frame, including which object is dominant; what is felt is chosen later.
/// In a frame that waits, all members but `picture` are those of the previous picture.
struct MeasuredFrame {
  FrameComparison picture = FrameComparison::kFirst;
  /// All lengths are the film's, and positions are from its middle, unless stated otherwise.
  FilmPlace place;
  int64_t interval_ns = 0;   ///< the time in which the motion happened, see Cadence; 0 with kFirst
  int64_t shown_for_ns = 0;  ///< see Cadence::Step
  int features = 0;          ///< points to track into the next frame
  /// Blocks that show how they move, or with motion=mean the points; empty with kFirst.
  std::vector<FollowedPoint> points;
  /// Zero unless motion=mean, with which all members below are empty.
  ImageMotion mean;
  std::optional<Background> background;  ///< how the camera moves; nothing with kFirst
  int votes = 0;                         ///< number of votes for the background
  std::vector<MovingObject> objects;     ///< known objects, visible or not, ordered by id
  uint32_t dominant = 0;                 ///< id of the object that motion=object feels; 0: none

  /// Null when no object is dominant.
  const MovingObject* dominant_object() const { return find_object(objects, dominant); }
  int width() const { return place.area.width; }  ///< of the film, px
  int height() const { return place.area.height; }
  double interval_s() const { return 1e-9 * static_cast<double>(interval_ns); }
  void clear_motion() {
    picture = FrameComparison::kFirst;
    interval_ns = shown_for_ns = 0;
    points.clear();
    mean = {};
    background.reset();
    votes = 0;
    objects.clear();
    dominant = 0;
  }
};

}  // namespace spidar
