// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/overlay/video_overlay.h"

#include <algorithm>
#include <cstdio>

#include "core/force/felt_force.h"
#include "plugin/filter/overlay/arrow.h"
#include "plugin/filter/overlay/frame_painter.h"
#include "plugin/filter/overlay/stroke_text.h"

namespace spidar {

namespace {

constexpr Rgb kProxy{255, 160, 30};
/// Height of a number, of the picture's.
constexpr double kNumberShare = 0.035;

/// In newtons, upright as it is shown, just beyond the tip of the arrow or where there is room.
void draw_newtons(double force_N, const Arrow& arrow, const VisiblePart& visible,
                  const PictureTurn& turn, FramePainter& painter) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f N", force_N);
  const double height_px = kNumberShare * visible.height;
  const double line_px = std::max(height_px / 7, 1.5);
  const Eigen::Vector2d size_px = height_px * Eigen::Vector2d(stroke_width_of(text), 1);
  const Eigen::Vector2d room_px = turn.to_coded(Eigen::Vector2d(size_px / 2)).cwiseAbs() +
                                  Eigen::Vector2d::Constant(2 * line_px);
  const Eigen::Vector2d first_px = painter.shown_px(Eigen::Vector2d(visible.x, visible.y));
  const Eigen::Vector2d end_px =
      painter.shown_px(Eigen::Vector2d(visible.x + visible.width, visible.y + visible.height));
  const Eigen::Vector2d along = (arrow.tip_px - arrow.tail_px).normalized();
  const Eigen::Vector2d beyond_px = arrow.tip_px + 2 * arrow.width_px * along;
  const Eigen::Vector2d middle_px = (beyond_px + along.cwiseProduct(room_px))
                                        .cwiseMin(end_px - room_px)
                                        .cwiseMax(first_px + room_px);
  const auto at_px = [&](const Eigen::Vector2d& in_text) -> Eigen::Vector2d {
    return middle_px + turn.to_coded(Eigen::Vector2d(height_px * in_text - size_px / 2));
  };
  for (const auto& [width_px, color] : {std::pair{3 * line_px, kBlack}, {line_px, kWhite}}) {
    for (const TextStroke& stroke : strokes_of(text)) {
      const Eigen::Vector2d from_px = at_px(stroke.from), to_px = at_px(stroke.to);
      // Longer by half of its width, so that corners are closed.
      const Eigen::Vector2d cap_px = width_px / 2 * (to_px - from_px).normalized();
      painter.stroke(from_px - cap_px, to_px + cap_px, width_px, color);
    }
  }
}

void draw_felt(const Wrench& wrench, const ArrowStyle& style, const VisiblePart& visible,
               FramePainter& painter) {
  const std::optional<FeltArrow> felt = felt_arrow(wrench, style);
  if (!felt) return;
  painter.draw(felt->border, kBlack);
  painter.draw(felt->arrow);
  const double force_N = wrench.force_N.norm();
  if (force_N >= kFeltForce_N) draw_newtons(force_N, felt->arrow, visible, style.turn, painter);
}

void draw_touch(const TouchMark& touch, const VisiblePart& visible, ArrowStyle style,
                FramePainter& painter) {
  // Place 0 is the left edge of the first pixel, half a pixel from its centre.
  const auto at_px = [&](const Eigen::Vector2d& place) {
    return painter.shown_px(Eigen::Vector2d(visible.x + place.x() * visible.width - 0.5,
                                            visible.y + place.y() * visible.height - 0.5));
  };
  const double ring_px = finger_radius_px(style.height_px), line_px = ring_px / 4;
  const Eigen::Vector2d finger_px = at_px(touch.finger);
  painter.disc(finger_px, ring_px + line_px, kBlack, ring_px - 2 * line_px);
  painter.disc(finger_px, ring_px, kWhite, ring_px - line_px);
  if (!touch.touching) return;
  const double radius_px = proxy_radius_px(touch, style.max_force_N, style.height_px);
  style.centre_px = at_px(touch.proxy);
  Wrench wrench;
  wrench.force_N = touch.force_N;
  draw_felt(wrench, style, visible, painter);
  painter.disc(style.centre_px, radius_px + line_px / 2, kBlack);
  painter.disc(style.centre_px, radius_px, kProxy);
}

/// Thick and orange where it is felt.
void draw_outline(const MovingObject& object, bool is_felt, const VisiblePart& visible,
                  FramePainter& painter) {
  const ObjectCorners box = corners_of(object, visible);
  const Eigen::Vector2d a = painter.shown_px(box.low_px), c = painter.shown_px(box.high_px);
  const Eigen::Vector2d b(c.x(), a.y()), d(a.x(), c.y());
  const double thin_px = std::max(visible.height / 480.0, 1.5);
  const auto line = [&](double width_px, Rgb color) {
    const Eigen::Vector2d end_px(width_px / 2, 0);  // closes the corners
    painter.stroke(a - end_px, b + end_px, width_px, color);
    painter.stroke(d - end_px, c + end_px, width_px, color);
    painter.stroke(a, d, width_px, color);
    painter.stroke(b, c, width_px, color);
  };
  if (!is_felt) return line(thin_px, kWhite);
  line(4 * thin_px, kBlack);
  line(2 * thin_px, kProxy);
}

}  // namespace

void draw_overlay(const SceneView& scene, bool has_tracks, const std::vector<uint32_t>& felt,
                  const VisiblePart& visible, double scale, double max_force_N,
                  const std::optional<TouchMark>& touch, GstVideoFrame& frame) {
  ArrowStyle style;
  style.scale = scale;
  style.max_force_N = max_force_N;
  style.turn = scene.turn;
  style.height_px = visible.height;
  style.pixel_aspect = pixel_aspect(frame.info);
  FramePainter painter(frame, visible);
  style.centre_px = painter.shown_px(force_origin_px(scene, felt, visible));
  if (has_tracks) {
    for (const Arrow& arrow : track_arrows(scene, style)) painter.draw(arrow);
    const double cross_px = felt_width_px(style);
    for (const ImagePoint& lost : scene.lost) {
      painter.cross(painter.shown_px({lost.x_px, lost.y_px}), cross_px, cross_px / 4, kWhite);
    }
  }
  for (const MovingObject& object : scene.objects) {
    const bool is_felt = std::find(felt.begin(), felt.end(), object.id) != felt.end();
    if (object.tracks > 0) draw_outline(object, is_felt, visible, painter);
  }
  draw_felt(scene.wrench, style, visible, painter);
  if (touch) draw_touch(*touch, visible, style, painter);
}

}  // namespace spidar
