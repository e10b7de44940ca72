// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "plugin/window/view/rect.h"

namespace spidar::window {

/// The largest rectangle of width / height = `aspect` (> 0) in the middle of `outer`.
Rect fit(const Rect& outer, double aspect);

/// The size of a window when it opens, at a scale of 1.
constexpr int kUsualWidth_px = 1280, kUsualHeight_px = 800;
/// The scale of text and lines: that of the screen, and more in a larger window, in steps of an
/// eighth, because each step loads the fonts again.
double text_scale(double screen_scale, int width, int height);

struct Layout {
  Rect picture, timeline, force, speed, gain, status;  ///< left
  Rect grip, tensions, controls;                       ///< right
};
/// The parts that have something to show.
struct Shown {
  bool speed = true, grip = true, tensions = true;
};
/// Places the panels of a debug window, in pixels from its upper left corner, in a frame buffer of
/// this size; `scale` is 1 where text of 14 pixels is readable. Parts that have nothing to show, or
/// would be too small to read, get an empty rectangle, and the others their space.
Layout lay_out(int width, int height, double scale, const Shown& shown = {});

/// Maps pixels of the frame to pixels of the window.
struct PictureMap {
  Rect shown;  ///< the visible part of the frame
  double frame_x = 0, frame_y = 0;
  double scale_x = 1, scale_y = 1;
  /// Maps `at_px`, where the centre of the first pixel is (0, 0).
  Eigen::Vector2d operator()(const Eigen::Vector2d& at_px) const {
    return {shown.x + (at_px.x() - frame_x + 0.5) * scale_x,
            shown.y + (at_px.y() - frame_y + 0.5) * scale_y};
  }
};
/// `pixel_aspect` is the width of a pixel over its height.
PictureMap map_picture(const Rect& panel, double frame_x, double frame_y, double frame_width,
                       double frame_height, double pixel_aspect);

/// A view of device frame D from the right and above: parallel lines stay parallel, so that lengths
/// along one direction can be compared.
class GripProjection {
 public:
  GripProjection(const Rect& panel, const StringGeometry& geometry);
  Eigen::Vector2d operator()(const Eigen::Vector3d& at_m) const;

 private:
  static Eigen::Vector2d flat_m(const Eigen::Vector3d& at_m);

  Eigen::Vector2d centre_px_;
  double px_m_;
};

}  // namespace spidar::window
