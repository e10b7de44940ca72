// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/overlay/arrow.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

constexpr double kShortest_px = 1.0;  ///< shorter arrows are drawn as dots
/// Length of the head: the smaller of this fraction of the arrow and this many shaft widths.
constexpr double kHeadFraction = 0.5;
constexpr double kHeadWidths = 4.0;

constexpr double kThin_px = 1.5, kBold_px = 2.5, kFelt_px = 6;  // widths at 480 lines
constexpr double kPale = 0.45;       ///< saturation of the background's arrows
constexpr double kFeltLength = 0.2;  ///< of the arrow of max_force_N / height of the picture

constexpr double kNarrowest_px = 1.5;  ///< of a line in a small picture

double width_px(double at_480, const ArrowStyle& style) {
  return std::max(kNarrowest_px, at_480 * style.height_px / kReferenceHeight_px);
}

}  // namespace

std::optional<ArrowHead> head_of(const Arrow& arrow) {
  const Eigen::Vector2d along_px = arrow.tip_px - arrow.tail_px;
  const double length_px = along_px.norm();
  if (!(length_px >= kShortest_px)) return std::nullopt;
  const Eigen::Vector2d unit = along_px / length_px;
  const Eigen::Vector2d side(-unit.y(), unit.x());
  const double head_px = std::min(kHeadFraction * length_px, kHeadWidths * arrow.width_px);
  const Eigen::Vector2d neck_px = arrow.tip_px - head_px * unit;
  const Eigen::Vector2d half_px = std::max(head_px / 2, arrow.width_px) * side;
  return ArrowHead{{neck_px - half_px, arrow.tip_px, neck_px + half_px}};
}

Rgb direction_color(const Eigen::Vector2d& direction, double saturation) {
  const double turns = std::atan2(-direction.y(), direction.x()) / (2 * M_PI);
  const auto channel = [&](double shift) {
    // HSV with V = 1: a channel is full within a sixth of the circle to either side of its hue, and
    // falls linearly to zero over the next sixth.
    double distance = std::fabs(turns - shift);
    distance = std::fabs(distance - std::round(distance));
    const double pure = std::clamp(2 - 6 * distance, 0.0, 1.0);
    return static_cast<uint8_t>(std::lround(255 * (1 - saturation * (1 - pure))));
  };
  return {channel(0), channel(1.0 / 3), channel(2.0 / 3)};
}

std::vector<Arrow> point_arrows(const std::vector<OwnedPoint>& points, const ArrowStyle& style,
                                const std::function<Eigen::Vector2d(const ImagePoint&)>& at_px) {
  std::vector<Arrow> arrows;
  arrows.reserve(points.size());
  for (const OwnedPoint& point : points) {
    Arrow arrow;
    arrow.tail_px = at_px(point.from);
    const Eigen::Vector2d moved_px = at_px(point.to) - arrow.tail_px;
    arrow.tip_px = arrow.tail_px + style.scale * moved_px;
    arrow.width_px = width_px(point.owner == PointOwner::kObject ? kBold_px : kThin_px, style);
    arrow.color = direction_color(moved_px, point.owner == PointOwner::kBackground ? kPale : 1);
    arrows.push_back(arrow);
  }
  return arrows;
}

double felt_width_px(const ArrowStyle& style) {
  return width_px(kFelt_px, style);
}

std::optional<Arrow> felt_arrow(const Wrench& wrench, const ArrowStyle& style) {
  if (!(style.max_force_N > 0)) return std::nullopt;
  const double px_N = kFeltLength * style.height_px / style.max_force_N;
  // Up is +y in the device frame and −y in the picture.
  const Eigen::Vector2d along_px =
      px_N * style.turn.to_stored(Eigen::Vector2d(wrench.force_N.x(), -wrench.force_N.y()));
  Arrow felt;
  felt.width_px = felt_width_px(style);
  if (!(along_px.norm() >= felt.width_px)) return std::nullopt;
  felt.tail_px = style.centre_px;
  felt.tip_px = style.centre_px + along_px;
  felt.color = kWhite;
  return felt;
}

}  // namespace spidar
