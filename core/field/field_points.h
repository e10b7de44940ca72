// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Points in the blocks of a field, which measure motion to a small fraction of a pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "core/field/block_field.h"
#include "core/field/reduced_frame.h"
#include "core/image_view.h"
#include "core/tracking/fine_window.h"
#include "core/tracking/luma_neighbourhood.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// How many points a block should have.
enum class PointWish : uint8_t {
  kNone,
  kSome,  ///< one for several blocks: the background, which moves as a whole
  kMany,  ///< one for each block: an object
};

/// Follows corners from where the field says they went: one window in the reduced picture and one
/// in the frame, without a search. A point that goes elsewhere is dropped.
class FieldPoints {
 public:
  /// Follows at most `most` points. With `refines`, also in the frame itself, not only in the
  /// reduced picture.
  struct Settings {
    int most = 64;
    bool refines = true;
  };

  FieldPoints();

  /// Looks for the points in `frame`, with which `field` has just been updated.
  void follow(const ImageView& frame, const ReducedFrame& reduced, const BlockField& field);

  /// Points found by the last follow(): where they were and where they are now.
  const std::vector<Track>& tracks() const { return tracks_; }

  /// The block at a place of the frame, px.
  static size_t block_at(const ReducedFrame& reduced, const BlockField& field, ImagePoint frame_px);

  /// Drops points of blocks that should have none and adds points where they are wanted; `wishes`
  /// has one entry for each block. Keeps what the next follow() needs of `frame`.
  void choose(const ImageView& frame, const ReducedFrame& reduced, const BlockField& field,
              const std::vector<PointWish>& wishes, const Settings& settings);

  int count() const { return static_cast<int>(points_.size()); }

  /// Forgets all points.
  void reset() { points_.clear(); }

 private:
  struct Point {
    uint32_t id = 0;
    ImagePoint at;     ///< px of the base
    ImagePoint frame;  ///< px of the frame
  };

  bool find(Point& point, const FineWindow& window, const ImageView& frame,
            const ReducedFrame& reduced, const BlockField& field);
  void add(PointWish wish, const ReducedFrame& reduced, const BlockField& field,
           const std::vector<PointWish>& wishes, const Settings& settings);

  std::vector<Point> points_;
  /// Of the points when they were chosen; may be longer than the list of points.
  std::vector<FineWindow> windows_;
  std::vector<Track> tracks_;
  std::vector<uint8_t> taken_;  ///< for each block, whether it has a point
  LumaNeighbourhood neighbourhood_;
  bool refines_ = true;
  uint32_t next_id_ = 0;
};

}  // namespace spidar
