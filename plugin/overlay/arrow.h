// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The arrows that motion is drawn with, in the video as in the window: shape and colour.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "plugin/overlay/scene_view.h"

namespace spidar {

/// 8 bits each, sRGB as video has it.
struct Rgb {
  uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb& o) const { return r == o.r && g == o.g && b == o.b; }
};

constexpr Rgb kWhite{255, 255, 255};
constexpr Rgb kBlack{0, 0, 0};

struct Arrow {
  Eigen::Vector2d tail_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d tip_px = Eigen::Vector2d::Zero();
  double width_px = 1.5;  ///< of the shaft
  Rgb color;
};

/// An arrow as two convex shapes: corners of the shaft, corners of the head, in order around them.
/// One without length is a square about its tail as wide as the shaft, without a head.
struct ArrowShape {
  std::array<Eigen::Vector2d, 4> shaft_px;
  std::array<Eigen::Vector2d, 3> head_px;
  bool has_head = true;
};
ArrowShape shape_of(const Arrow& arrow);
/// What lies within `margin_px` of that shape, its corners drawn out to points: everywhere as wide
/// a border, where the shape is drawn over it.
ArrowShape border_of(const Arrow& arrow, double margin_px);

/// Hue of a direction of the picture (y down): right red, up green-yellow, left cyan, down violet.
/// `saturation` 0 … 1.
Rgb direction_color(const Eigen::Vector2d& direction, double saturation);

/// How a scene is drawn.
struct ArrowStyle {
  double scale = 4;          ///< length of an arrow to the displacement it stands for, > 0
  double height_px = 480;    ///< of what is drawn on: gives the widths
  double max_force_N = 3.0;  ///< the felt arrow has a fifth of the height at this force
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  ///< where the felt arrow begins
};

/// Width of the felt arrow's shaft.
double felt_width_px(const ArrowStyle& style);

/// One arrow a track, tail at `from`: objects bold and in full colour, the background pale.
std::vector<Arrow> track_arrows(const SceneView& scene, const ArrowStyle& style);

/// The force that is felt, from the centre on, white, with a black border to be drawn first; it
/// lies in the picture as it pushes the hand. Nothing when it is too short to show a direction.
struct FeltArrow {
  ArrowShape border;
  Arrow arrow;
};
std::optional<FeltArrow> felt_arrow(const Wrench& wrench, const ArrowStyle& style);

}  // namespace spidar
