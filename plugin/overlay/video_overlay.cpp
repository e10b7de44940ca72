// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/overlay/video_overlay.h"

#include "plugin/overlay/arrow.h"
#include "plugin/overlay/frame_painter.h"

namespace spidar {

namespace {

constexpr Rgb kProxy{255, 160, 30};

void draw_felt(const Wrench& wrench, const ArrowStyle& style, FramePainter& painter) {
  const std::optional<FeltArrow> felt = felt_arrow(wrench, style);
  if (!felt) return;
  painter.draw(felt->border, kBlack);
  painter.draw(felt->arrow);
}

void draw_touch(const TouchMark& touch, const VisiblePart& visible, ArrowStyle style,
                FramePainter& painter) {
  // Place 0 is the left edge of the first pixel, half a pixel from its centre.
  const auto at_px = [&](const Eigen::Vector2d& place) {
    return Eigen::Vector2d(visible.x + place.x() * visible.width - 0.5,
                           visible.y + place.y() * visible.height - 0.5);
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
  draw_felt(wrench, style, painter);
  painter.disc(style.centre_px, radius_px + line_px / 2, kBlack);
  painter.disc(style.centre_px, radius_px, kProxy);
}

}  // namespace

void draw_overlay(const SceneView& scene, const VisiblePart& visible, double scale,
                  double max_force_N, const std::optional<TouchMark>& touch, GstVideoFrame& frame) {
  ArrowStyle style;
  style.scale = scale;
  style.max_force_N = max_force_N;
  style.turn = scene.turn;
  style.height_px = visible.height;
  style.centre_px = {visible.x + 0.5 * (visible.width - 1), visible.y + 0.5 * (visible.height - 1)};
  FramePainter painter(frame);
  for (const Arrow& arrow : track_arrows(scene, style)) painter.draw(arrow);

  const double cross_px = felt_width_px(style);
  for (const ImagePoint& lost : scene.lost) {
    painter.cross({lost.x_px, lost.y_px}, cross_px, cross_px / 4, kWhite);
  }
  draw_felt(scene.wrench, style, painter);
  if (touch) draw_touch(*touch, visible, style, painter);
}

}  // namespace spidar
