// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>

#include "plugin/overlay/arrow.h"
#include "plugin/window/panels.h"

namespace spidar {
namespace {

constexpr ImU32 kObjectColor = IM_COL32(255, 255, 255, 160);
constexpr ImU32 kNewColor = IM_COL32(255, 255, 255, 255);

ImU32 color_of(Rgb color) {
  return IM_COL32(color.r, color.g, color.b, 255);
}

void draw_arrow(const Brush& brush, const Arrow& arrow) {
  const ArrowShape shape = shape_of(arrow);
  const ImU32 color = color_of(arrow.color);
  std::array<ImVec2, 4> shaft;
  std::transform(shape.shaft_px.begin(), shape.shaft_px.end(), shaft.begin(),
                 [](const Eigen::Vector2d& p) { return im(p); });
  brush.list.AddConvexPolyFilled(shaft.data(), static_cast<int>(shaft.size()), color);
  if (!shape.has_head) return;
  brush.list.AddTriangleFilled(im(shape.head_px[0]), im(shape.head_px[1]), im(shape.head_px[2]),
                               color);
}

void draw_points(const Brush& brush, const PictureMap& map, const SceneView& scene) {
  const auto radius = static_cast<float>(3 * brush.scale);
  const auto width = static_cast<float>(brush.scale);
  for (const SceneTrack& track : scene.tracks) {
    if (!track.is_new) continue;
    brush.list.AddCircle(im(map({track.to.x_px, track.to.y_px})), radius, kNewColor, 0, width);
  }
  for (const ImagePoint& lost : scene.lost) {
    const ImVec2 at = im(map({lost.x_px, lost.y_px}));
    brush.list.AddLine({at.x - radius, at.y - radius}, {at.x + radius, at.y + radius}, kWarnColor,
                       width);
    brush.list.AddLine({at.x - radius, at.y + radius}, {at.x + radius, at.y - radius}, kWarnColor,
                       width);
  }
}

void draw_objects(const Brush& brush, const PictureMap& map, const FrameFacts& facts) {
  const VisiblePart& visible = facts.visible;
  const Eigen::Vector2d centre_px(visible.x + 0.5 * (visible.width - 1),
                                  visible.y + 0.5 * (visible.height - 1));
  for (const MovingObject& object : facts.scene.objects) {
    if (object.tracks == 0) continue;
    const Eigen::Vector2d half_px = object.size_px / 2;
    const ImVec2 low = im(map(centre_px + object.position_px - half_px));
    const ImVec2 high = im(map(centre_px + object.position_px + half_px));
    brush.list.AddRect(low, high, kObjectColor, 0, 0, static_cast<float>(brush.scale));
    brush.list.AddText({low.x + 2, low.y}, kObjectColor,
                       ("object " + std::to_string(object.id)).c_str());
  }
}

}  // namespace

void draw_picture(const Brush& brush, const Rect& panel, const ShownPicture& picture,
                  const FrameFacts& facts, double arrow_scale, double max_force_N) {
  brush.list.AddRectFilled(upper_left(panel), lower_right(panel), kPanelColor);
  const VisiblePart& visible = facts.visible;
  if (!picture.texture || visible.width <= 0 || visible.height <= 0) {
    brush.list.AddText(im(panel.x + 8 * brush.scale, panel.y + 8 * brush.scale), kTextColor,
                       "no frame yet");
    return;
  }
  const PictureMap map =
      map_picture(panel, visible.x, visible.y, visible.width, visible.height, picture.pixel_aspect);
  const double w = picture.frame_width, h = picture.frame_height;
  brush.list.AddImage(picture.texture, upper_left(map.shown), lower_right(map.shown),
                      im(visible.x / w, visible.y / h),
                      im((visible.x + visible.width) / w, (visible.y + visible.height) / h));
  brush.list.PushClipRect(upper_left(map.shown), lower_right(map.shown), true);

  ArrowStyle style;
  style.scale = arrow_scale;
  style.height_px = map.shown.height;
  style.max_force_N = max_force_N;
  for (Arrow arrow : track_arrows(facts.scene, style)) {
    arrow.tail_px = map(arrow.tail_px);
    arrow.tip_px = map(arrow.tip_px);
    draw_arrow(brush, arrow);
  }
  draw_points(brush, map, facts.scene);
  draw_objects(brush, map, facts);
  style.centre_px = {map.shown.x + map.shown.width / 2, map.shown.y + map.shown.height / 2};
  if (const std::optional<FeltArrow> felt = felt_arrow(facts.scene.wrench, style)) {
    draw_arrow(brush, felt->border);
    draw_arrow(brush, felt->arrow);
  }
  brush.list.PopClipRect();
}

}  // namespace spidar
