// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/default_limits.h"
#include "plugin/frame/frame_report.h"

namespace spidar {

/// A nonlinear 8-bit RGB colour.
struct Rgb {
  uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb& o) const { return r == o.r && g == o.g && b == o.b; }
};

constexpr Rgb kWhite{255, 255, 255};
constexpr Rgb kBlack{0, 0, 0};

/// A line with a head that shows motion or force, in the video and in the window.
struct Arrow {
  Eigen::Vector2d tail_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d tip_px = Eigen::Vector2d::Zero();
  double width_px = 1.5;  ///< of the line
  Rgb color;
};

/// The head of an arrow, a triangle. The line of the arrow ends at neck_px(). An arrow without
/// length has no head, and is drawn as a dot.
struct ArrowHead {
  std::array<Eigen::Vector2d, 3> corners_px;  ///< the second one is the tip
  Eigen::Vector2d neck_px() const { return (corners_px[0] + corners_px[2]) / 2; }
};
std::optional<ArrowHead> head_of(const Arrow& arrow);

/// Colour for a direction in the picture (y down): right red, up green-yellow, left cyan, down
/// violet. `saturation` 0 … 1.
Rgb direction_color(const Eigen::Vector2d& direction, double saturation);

struct ArrowStyle {
  double scale = 4;                      ///< arrow length / displacement, > 0
  double height_px = 480;                ///< height of the picture; line widths scale with it
  double max_force_N = kDefaultForce_N;  ///< the force whose arrow is a fifth of height_px long
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< the tail of the force's arrow
  Orientation turn;                                     ///< of the drawing, before it is shown
};

/// Width of the line of the force's arrow, px.
double felt_width_px(const ArrowStyle& style);

/// One arrow per point with its tail at `from`: bold for objects, pale for the background. `at_px`
/// maps a point of the frame to where it is drawn.
std::vector<Arrow> point_arrows(const std::vector<OwnedPoint>& points, const ArrowStyle& style,
                                const std::function<Eigen::Vector2d(const ImagePoint&)>& at_px);

/// The force as a white arrow from the centre, in the direction in which it pushes the hand. Empty
/// when the arrow is too short to show a direction.
std::optional<Arrow> felt_arrow(const Wrench& wrench, const ArrowStyle& style);

}  // namespace spidar
