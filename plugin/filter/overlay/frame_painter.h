// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Draws shapes into video frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <gst/video/video.h>

#include "plugin/filter/frame/frame_luma.h"
#include "plugin/filter/overlay/arrow.h"

namespace spidar {

/// Draws into a frame mapped for writing. Supports every format whose components have one or two
/// bytes each: grey, planar and semi-planar YUV, packed RGB. YUV follows the frame's colorimetry; a
/// subsampled chroma sample is set when any of its pixels is. Shapes are clipped to the visible
/// part. Coordinates are in square pixels (see shown_px()), with (0, 0) at the centre of the first
/// one.
class FramePainter {
 public:
  FramePainter(GstVideoFrame& frame, const VisiblePart& visible)
      : frame_(frame), visible_(visible), pixel_aspect_(pixel_aspect(frame.info)) {}

  /// A place in pixels of the frame, as it is drawn at.
  Eigen::Vector2d shown_px(const Eigen::Vector2d& stored_px) const {
    return {shown_x(stored_px.x()), stored_px.y()};
  }

  void draw(const Arrow& arrow) { draw(shape_of(arrow), arrow.color); }
  void draw(const ArrowShape& shape, Rgb color);
  /// A straight line from end to end.
  void stroke(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px, double width_px,
              Rgb color);
  /// A cross of two strokes, each `size_px` long.
  void cross(const Eigen::Vector2d& centre_px, double size_px, double width_px, Rgb color);
  /// A disc, or a ring whose hole has the radius `hole_px`.
  void disc(const Eigen::Vector2d& centre_px, double radius_px, Rgb color, double hole_px = -1);

 private:
  using Components = std::array<uint16_t, 4>;

  Components components_of(Rgb color) const;
  /// Fills a convex polygon with corners in order: all pixels whose centre is inside or on its
  /// border.
  void fill(const Eigen::Vector2d* corners_px, size_t count, const Components& value);
  void set(int x, int y, const Components& value);
  // The left edge of the first pixel stays in place.
  double shown_x(double x) const { return (x + 0.5) * pixel_aspect_ - 0.5; }
  double stored_x(double x) const { return (x + 0.5) / pixel_aspect_ - 0.5; }

  GstVideoFrame& frame_;
  VisiblePart visible_;
  double pixel_aspect_;
};

}  // namespace spidar
