// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/overlay/arrow.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// Shorter arrows are drawn as squares.
constexpr double kShortest_px = 1.0;
/// Length of the head: the smaller of this share of the arrow and this many shaft widths.
constexpr double kHeadShare = 0.5;
constexpr double kHeadWidths = 4.0;

constexpr double kThin_px = 1.5, kBold_px = 2.5, kFelt_px = 6;  // in a picture 480 lines high
constexpr double kPale = 0.45;
constexpr double kFeltLength = 0.2;

/// A narrower shaft would have gaps, because a pixel is drawn when its centre is inside.
constexpr double kNarrowest_px = 1.5;

double width_px(double at_480, const ArrowStyle& style) {
  return std::max(kNarrowest_px, at_480 * style.height_px / kReferenceHeight_px);
}

/// In square pixels; the left edge of the first pixel stays in place.
Eigen::Vector2d shown_px(const ImagePoint& point, const ArrowStyle& style) {
  return {(point.x_px + 0.5) * style.pixel_aspect - 0.5, point.y_px};
}

}  // namespace

ArrowShape shape_of(const Arrow& arrow) {
  const Eigen::Vector2d along_px = arrow.tip_px - arrow.tail_px;
  const double length_px = along_px.norm();
  ArrowShape shape;
  if (length_px < kShortest_px) {
    const double half_px = arrow.width_px / 2;
    const Eigen::Vector2d a(half_px, half_px), b(half_px, -half_px);
    shape.shaft_px = {arrow.tail_px - a, arrow.tail_px + b, arrow.tail_px + a, arrow.tail_px - b};
    shape.has_head = false;
    return shape;
  }
  const Eigen::Vector2d unit = along_px / length_px;
  const Eigen::Vector2d side(-unit.y(), unit.x());
  const double head_px = std::min(kHeadShare * length_px, kHeadWidths * arrow.width_px);
  const Eigen::Vector2d neck_px = arrow.tip_px - head_px * unit;
  const Eigen::Vector2d half_shaft_px = arrow.width_px / 2 * side;
  const Eigen::Vector2d half_head_px = std::max(head_px / 2, arrow.width_px) * side;
  shape.shaft_px = {arrow.tail_px - half_shaft_px, neck_px - half_shaft_px, neck_px + half_shaft_px,
                    arrow.tail_px + half_shaft_px};
  shape.head_px = {neck_px - half_head_px, arrow.tip_px, neck_px + half_head_px};
  return shape;
}

ArrowShape border_of(const Arrow& arrow, double margin_px) {
  ArrowShape shape = shape_of(arrow);
  Eigen::Vector2d along = arrow.tip_px - arrow.tail_px;
  along = shape.has_head ? Eigen::Vector2d(along.normalized()) : Eigen::Vector2d(1, 0);
  const Eigen::Vector2d side(-along.y(), along.x());
  const Eigen::Vector2d back_px = margin_px * along, out_px = margin_px * side;
  // The front end of the shaft lies inside the head and needs no margin.
  const double ahead = shape.has_head ? 0 : 1;
  shape.shaft_px[0] += -back_px - out_px;
  shape.shaft_px[1] += ahead * back_px - out_px;
  shape.shaft_px[2] += ahead * back_px + out_px;
  shape.shaft_px[3] += -back_px + out_px;
  if (!shape.has_head) return shape;
  // Offsets all sides of the head outwards by the margin, which preserves its angles.
  const Eigen::Vector2d neck_px = (shape.head_px[0] + shape.head_px[2]) / 2;
  const double length_px = (shape.head_px[1] - neck_px).norm();
  const double half_px = (shape.head_px[2] - neck_px).norm();
  const double ahead_px = margin_px * std::hypot(length_px, half_px) / half_px;
  const double grown = (length_px + margin_px + ahead_px) / length_px;
  shape.head_px = {neck_px - back_px - grown * half_px * side, shape.head_px[1] + ahead_px * along,
                   neck_px - back_px + grown * half_px * side};
  return shape;
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

std::vector<Arrow> track_arrows(const SceneView& scene, const ArrowStyle& style) {
  std::vector<Arrow> arrows;
  arrows.reserve(scene.tracks.size());
  for (const SceneTrack& track : scene.tracks) {
    Arrow arrow;
    arrow.tail_px = shown_px(track.from, style);
    const Eigen::Vector2d moved_px = shown_px(track.to, style) - arrow.tail_px;
    arrow.tip_px = arrow.tail_px + style.scale * moved_px;
    arrow.width_px = width_px(track.owner == TrackOwner::kObject ? kBold_px : kThin_px, style);
    arrow.color = direction_color(moved_px, track.owner == TrackOwner::kBackground ? kPale : 1);
    arrows.push_back(arrow);
  }
  return arrows;
}

double felt_width_px(const ArrowStyle& style) {
  return width_px(kFelt_px, style);
}

std::optional<FeltArrow> felt_arrow(const Wrench& wrench, const ArrowStyle& style) {
  if (!(style.max_force_N > 0)) return std::nullopt;
  const double px_N = kFeltLength * style.height_px / style.max_force_N;
  // Up is +y in the device frame and −y in the picture.
  const Eigen::Vector2d along_px =
      px_N * style.turn.to_coded(Eigen::Vector2d(wrench.force_N.x(), -wrench.force_N.y()));
  FeltArrow felt;
  felt.arrow.width_px = felt_width_px(style);
  if (along_px.norm() < felt.arrow.width_px) return std::nullopt;
  felt.arrow.tail_px = style.centre_px;
  felt.arrow.tip_px = style.centre_px + along_px;
  felt.arrow.color = kWhite;
  felt.border = border_of(felt.arrow, felt.arrow.width_px / 4);
  return felt;
}

}  // namespace spidar
