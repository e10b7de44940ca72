// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Interface of the point trackers.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/api.h"
#include "core/image_view.h"

namespace spidar {

/// Height of the reference frame. Lengths in settings are pixels of a frame with 480 lines, so that
/// a setting has the same effect at 360p and at 2160p.
constexpr double kReferenceHeight_px = 480.0;

enum class TrackerKind {
  kPatch,   ///< small windows from coarse to fine, see PatchTracker
  kOpenCv,  ///< the paper's: OpenCV's Shi–Tomasi points and Lucas–Kanade
};

/// Trade-off between time per frame and accuracy, for kPatch.
enum class TrackerQuality {
  kFast,      ///< in the reduced picture only, with small windows
  kBalanced,  ///< refined in the frame where it helps
  kFine,      ///< as kBalanced, with more points on the grid and fewer in moving regions
};

struct TrackerSettings {
  int max_features = 200;       ///< 1 … 10000 points followed at once
  double quality_level = 0.01;  ///< Shi–Tomasi: share of the strongest corner's eigenvalue, 0 … 1
  /// Minimum distance between selected features, in pixels of the reference frame; finite and ≥ 0.
  double min_distance_px = 10.0;
  TrackerKind kind = TrackerKind::kPatch;
  TrackerQuality quality = TrackerQuality::kBalanced;

  bool operator==(const TrackerSettings& o) const {
    return max_features == o.max_features && quality_level == o.quality_level &&
           min_distance_px == o.min_distance_px && kind == o.kind && quality == o.quality;
  }
  bool operator!=(const TrackerSettings& o) const { return !(*this == o); }
};

/// Throws std::invalid_argument when a value is out of the range given in TrackerSettings.
SPIDAR_API void validate(const TrackerSettings& settings);

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

/// Which pictures count as repetitions of the previous one.
enum class Repeats {
  kSame,   ///< identical pixels, reported as rest
  kAlike,  ///< also pictures equal within coding noise, see RepeatedPicture
};

struct TrackedFrame {
  std::vector<Track> tracks;  ///< points found in both frames; empty after a restart
  int features = 0;           ///< points to search in the next frame
  bool restarted = false;     ///< first frame, new size, or a cut: no comparison was possible
  /// The frame repeats the previous picture, with which the next frame will be compared. With kSame
  /// the tracks are at rest; with kAlike they are those of the previous frame.
  bool repeated = false;
  /// `repeated` is false but would be true with kAlike.
  bool alike = false;
};

/// Follows points through a sequence of frames of one size.
class SPIDAR_API Tracker {
 public:
  virtual ~Tracker() = default;

  /// Compares `frame` with the previous one. A frame of another size restarts the tracks, as does a
  /// cut (a frame in which hardly any point is found again). The result is valid until the next
  /// call. Throws as require_usable() does.
  virtual const TrackedFrame& track(const ImageView& frame, Repeats repeats) = 0;
  const TrackedFrame& track(const ImageView& frame) { return track(frame, Repeats::kSame); }

  /// Discards the previous frame, so that the next one starts anew without motion.
  virtual void restart() = 0;

  /// Takes effect with the next frame; the kind cannot change. Throws as validate() does, and then
  /// changes nothing.
  virtual void configure(const TrackerSettings& settings) = 0;
};

/// Creates a tracker of `settings.kind`. Throws as validate() does.
SPIDAR_API std::unique_ptr<Tracker> make_tracker(const TrackerSettings& settings);

}  // namespace spidar
