// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/picture/image_view.h"
#include "core/picture/repeated_picture.h"

namespace spidar {

/// How OpenCvTracker selects points (Shi–Tomasi).
struct TrackerSettings {
  double quality_level = 0.01;  ///< of the strongest corner's eigenvalue, 0 … 1
  /// The minimum distance between selected features, px of the reference frame; finite and ≥ 0.
  double min_distance_px = 10.0;

  bool operator==(const TrackerSettings& o) const {
    return quality_level == o.quality_level && min_distance_px == o.min_distance_px;
  }
  bool operator!=(const TrackerSettings& o) const { return !(*this == o); }
};

/// Throws std::invalid_argument when a value is out of the range given in TrackerSettings.
void validate(const TrackerSettings& settings);

/// Position in the image frame I, pixels of the frame given to track(); x right, y down, the centre
/// of the first pixel is (0, 0).
struct ImagePoint {
  float x_px = 0;
  float y_px = 0;
};

/// A point found in the previous frame and in this one.
struct FollowedPoint {
  uint32_t id = 0;  ///< the same for as long as the point is followed
  ImagePoint from;
  ImagePoint to;
};

/// The tracker of the paper, with Shi–Tomasi points and pyramidal Lucas–Kanade. Follows points in a
/// picture reduced to about 480 px, and builds one pyramid per frame, which is reused for the next
/// frame. Drops points that leave the picture, are not found, fail the forward–backward check, or
/// look different. Selects new points when few are left and every few frames, so that objects that
/// enter are found.
class OpenCvTracker {
 public:
  struct Result {
    std::vector<FollowedPoint> points;  ///< found in both frames; empty with kFirst
    int features = 0;                   ///< the points to look for in the next frame
    /// With kSame the next frame is compared with the same picture as this one. Never kWaiting.
    FrameComparison picture = FrameComparison::kFirst;
  };

  explicit OpenCvTracker(const TrackerSettings& settings = {});
  ~OpenCvTracker();

  /// Compares `frame` with the previous one. A frame of another size restarts the points, as does a
  /// cut (a frame in which hardly any point is found again). In a frame that repeats the picture,
  /// points are at rest. With `may_wait`, a frame that is equal within the noise of coding counts
  /// as kSame, too, and the points stay those of the previous frame. The result is valid until the
  /// next call. Throws as require_usable() does.
  const Result& track(const ImageView& frame, bool may_wait = false);
  const Result& result() const;  ///< of the last track()

  /// Discards the previous frame, so that the next one starts anew without motion.
  void reset();

  /// Applies from the next frame on. Throws as validate() does, and then changes nothing.
  void configure(const TrackerSettings& settings);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spidar
