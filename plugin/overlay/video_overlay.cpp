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

  Arrow felt = felt_arrow(scene.wrench, style);
  for (const ImagePoint& lost : scene.lost) {
    painter.cross({lost.x_px, lost.y_px}, felt.width_px, felt.width_px / 4, kWhite);
  }
  if ((felt.tip_px - felt.tail_px).norm() < felt.width_px) return;  // too small to show a direction
  Arrow border = felt;
  const Eigen::Vector2d unit = (felt.tip_px - felt.tail_px).normalized();
  const double margin_px = felt.width_px / 4;
  border.tail_px -= margin_px * unit;
  border.tip_px += 2 * margin_px * unit;
  border.width_px += 2 * margin_px;
  border.color = kBlack;
  painter.draw(border);
  painter.draw(felt);
}

}  // namespace spidar
