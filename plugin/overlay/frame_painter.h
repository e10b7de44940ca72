// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Shapes drawn into video frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <gst/video/video.h>

#include "plugin/overlay/arrow.h"

namespace spidar {

/// Draws into a frame mapped for writing, of any format whose components have a byte or a word
/// each: grey, planar and semi-planar YUV, packed RGB. YUV follows the frame's colorimetry; of
/// subsampled chroma a sample is set when a pixel of it is. What is outside the frame is not drawn.
/// Coordinates are pixels, the centre of the first one is (0, 0).
class FramePainter {
 public:
  explicit FramePainter(GstVideoFrame& frame) : frame_(frame) {}

  void draw(const Arrow& arrow) { draw(shape_of(arrow), arrow.color); }
  void draw(const ArrowShape& shape, Rgb color);
  /// A cross of two strokes, each `size_px` long.
  void cross(const Eigen::Vector2d& centre_px, double size_px, double width_px, Rgb color);
  /// A disc, or a ring whose hole has the radius `hole_px`.
  void disc(const Eigen::Vector2d& centre_px, double radius_px, Rgb color, double hole_px = -1);

 private:
  using Components = std::array<uint16_t, 4>;

  Components components_of(Rgb color) const;
  /// Corners in order around a convex shape; pixels whose centre is inside or on the border.
  void fill(const Eigen::Vector2d* corners_px, size_t count, const Components& value);
  void set(int x, int y, const Components& value);

  GstVideoFrame& frame_;
};

}  // namespace spidar
