// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where things are in a debug window, in pixels from its upper left corner.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/grip/pose.h"
#include "plugin/device/device_view.h"
#include "plugin/window/view/rect.h"

namespace spidar {

/// The largest rectangle of width / height = `aspect` (> 0) in the middle of `outer`.
Rect fit(const Rect& outer, double aspect);

struct WindowLayout {
  Rect picture, timeline, force, speed, gain, status;  ///< left
  Rect grip, tensions, controls;                       ///< right
};
/// For a frame buffer of this size; `scale` is 1 where text of 14 pixels can be read.
WindowLayout lay_out(int width, int height, double scale);

/// The place for a label that is nearest to `wanted`, within `panel` and beside all that is
/// `taken`; nothing when there is none.
std::optional<Rect> place_label(const Rect& panel, const Rect& wanted,
                                const std::vector<Rect>& taken);

/// From pixels of the frame to pixels of the window.
struct PictureMap {
  Rect shown;  ///< the visible part of the frame
  double frame_x = 0, frame_y = 0;
  double scale_x = 1, scale_y = 1;
  /// `at_px` with the centre of the first pixel at (0, 0).
  Eigen::Vector2d operator()(const Eigen::Vector2d& at_px) const {
    return {shown.x + (at_px.x() - frame_x + 0.5) * scale_x,
            shown.y + (at_px.y() - frame_y + 0.5) * scale_y};
  }
};
/// `pixel_aspect`: width of a pixel over its height.
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

/// The tension of one string.
struct TensionBar {
  Rect range;          ///< from no tension, below, to the largest
  Rect filled;         ///< as much of it as there is
  double least_y = 0;  ///< of the smallest tension
};
/// What a panel of tensions leaves to its bars: above is its title, on the left are the numbers of
/// the axis, below those of the strings.
Rect tension_area(const Rect& panel, double scale);
/// Beside each other over the width of `area`, in the order of the strings.
std::vector<TensionBar> tension_bars(const Rect& area, const DeviceView& device);

}  // namespace spidar
