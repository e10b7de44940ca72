// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/overlay/video_overlay.h"

#include "plugin/overlay/arrow.h"
#include "plugin/overlay/frame_painter.h"

namespace spidar {

void draw_overlay(const SceneView& scene, const VisiblePart& visible, double scale,
                  double max_force_N, GstVideoFrame& frame) {
  ArrowStyle style;
  style.scale = scale;
  style.max_force_N = max_force_N;
  style.height_px = visible.height;
  style.centre_px = {visible.x + 0.5 * (visible.width - 1), visible.y + 0.5 * (visible.height - 1)};
  FramePainter painter(frame);
  for (const Arrow& arrow : track_arrows(scene, style)) painter.draw(arrow);

  const double cross_px = felt_width_px(style);
  for (const ImagePoint& lost : scene.lost) {
    painter.cross({lost.x_px, lost.y_px}, cross_px, cross_px / 4, kWhite);
  }
  if (const std::optional<FeltArrow> felt = felt_arrow(scene.wrench, style)) {
    painter.draw(felt->border, kBlack);
    painter.draw(felt->arrow);
  }
}

}  // namespace spidar
