// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Points of a picture that are found again in the next, and the settings of finding them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image_view.h"
#include "core/tracking/picture_kind.h"

namespace spidar {

/// Height of the reference frame. Lengths in settings are pixels of a frame with 480 lines, so that
/// a setting has the same effect at 360p and at 2160p.
constexpr double kReferenceHeight_px = 480.0;

/// Of OpenCvTracker (Shi–Tomasi).
struct TrackerSettings {
  double quality_level = 0.01;  ///< share of the strongest corner's eigenvalue, 0 … 1
  /// Minimum distance between selected features, in pixels of the reference frame; finite and ≥ 0.
  double min_distance_px = 10.0;

  bool operator==(const TrackerSettings& o) const {
    return quality_level == o.quality_level && min_distance_px == o.min_distance_px;
  }
  bool operator!=(const TrackerSettings& o) const { return !(*this == o); }
};

/// Throws std::invalid_argument when a value is out of the range given in TrackerSettings.
void validate(const TrackerSettings& settings);

/// Minimum width and height that a tracker accepts, px.
constexpr int kMinSide_px = 16;

/// Throws std::invalid_argument when the frame has no pixels, less than kMinSide_px a side, a
/// stride below its width, or a sample format that LumaSample does not support.
void require_usable(const ImageView& frame);

/// Position in the image frame I, pixels of the frame given to track(); x right, y down, the centre
/// of the first pixel is (0, 0).
struct ImagePoint {
  float x_px = 0;
  float y_px = 0;
};

/// A point found in the previous frame and in this one.
struct Track {
  uint32_t id = 0;  ///< the same for as long as the point is followed
  ImagePoint from;
  ImagePoint to;
};

struct TrackedFrame {
  std::vector<Track> tracks;  ///< points found in both frames; empty with kFirst
  int features = 0;           ///< points to search in the next frame
  /// With kSame the next frame will be compared with the same picture as this one. Never kWaiting.
  PictureKind picture = PictureKind::kFirst;
};

}  // namespace spidar
