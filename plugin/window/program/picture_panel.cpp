// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <utility>

#include "core/force/motion_rendering.h"
#include "plugin/frame/point_owners.h"
#include "plugin/overlay/arrow.h"
#include "plugin/window/program/panels.h"
#include "spidar/text.h"

namespace spidar::window {
namespace {

constexpr unsigned kFelt = 210, kFaint = 64;  // opacity of points without detail
constexpr double kThinArrow_px = 1;           // their width
constexpr ImU32 kNewColor = IM_COL32(255, 255, 255, 255);
constexpr ImU32 kOtherColor = IM_COL32(255, 255, 255, 90);
constexpr ImU32 kFilmColor = IM_COL32(90, 200, 250, 160);

/// What is drawn over the picture, in the coordinates of the window.
struct Overlay {
  const Brush& brush;
  const PictureMap& map;
  const DrawnFrame& report;
  const ShownPicture& picture;

  bool is_felt(uint32_t object) const {
    return std::find(report.felt.begin(), report.felt.end(), object) != report.felt.end();
  }
  std::pair<Eigen::Vector2d, Eigen::Vector2d> box(const MovingObject& object) const {
    const Eigen::AlignedBox2d box = box_px(object, report.film_part());
    return {map(box.min()), map(box.max())};
  }
};

ImU32 color_of(Rgb color, unsigned opacity) {
  return IM_COL32(color.r, color.g, color.b, opacity);
}

void draw_arrow(const Brush& brush, const Arrow& arrow, ImU32 color, float margin = 0) {
  const auto width = static_cast<float>(arrow.width_px) + 2 * margin;
  const std::optional<ArrowHead> head = head_of(arrow);
  if (!head) return brush.list.AddCircleFilled(im(arrow.tail_px), width / 2, color);
  const std::array<ImVec2, 3> corners{im(head->corners_px[0]), im(head->corners_px[1]),
                                      im(head->corners_px[2])};
  brush.list.AddLine(im(arrow.tail_px), im(head->neck_px()), color, width);
  brush.list.AddTriangleFilled(corners[0], corners[1], corners[2], color);
  if (margin > 0) brush.list.AddTriangle(corners[0], corners[1], corners[2], color, 2 * margin);
}

void draw_motion_of_points(const Overlay& over, const ArrowStyle& style) {
  const std::vector<OwnedPoint>& points = over.report.points;
  const auto at_px = [&](const ImagePoint& at) { return over.map({at.x_px, at.y_px}); };
  std::vector<Arrow> arrows = point_arrows(points, style, at_px);  // one for each point
  for (size_t i = 0; i < arrows.size(); ++i) {
    const bool is_felt = points[i].owner == PointOwner::kObject && over.is_felt(points[i].object);
    if (!over.picture.detail) {
      arrows[i].width_px = kThinArrow_px * over.brush.scale;
      arrows[i].color = kWhite;
    }
    const unsigned opacity = over.picture.detail ? 255 : is_felt ? kFelt : kFaint;
    draw_arrow(over.brush, arrows[i], color_of(arrows[i].color, opacity));
  }
}

void draw_new_and_lost(const Overlay& over) {
  const Brush& brush = over.brush;
  const float radius = brush.px(3), width = brush.px(1);
  for (const OwnedPoint& point : over.report.points) {
    if (!point.is_new) continue;
    brush.list.AddCircle(im(over.map({point.to.x_px, point.to.y_px})), radius, kNewColor, 0, width);
  }
  for (const ImagePoint& lost : over.report.lost) {
    const ImVec2 at = im(over.map({lost.x_px, lost.y_px}));
    brush.list.AddLine({at.x - radius, at.y - radius}, {at.x + radius, at.y + radius}, kWarnColor,
                       width);
    brush.list.AddLine({at.x - radius, at.y + radius}, {at.x + radius, at.y - radius}, kWarnColor,
                       width);
  }
}

/// Draws the border of the film area.
void draw_area(const Overlay& over) {
  const PicturePart film = over.report.film_part();
  const Eigen::Vector2d corner(film.x, film.y), half(0.5, 0.5);
  const Eigen::Vector2d far_corner = corner + Eigen::Vector2d(film.width, film.height);
  over.brush.list.AddRect(im(over.map(corner - half)), im(over.map(far_corner - half)), kFilmColor,
                          0, 0, over.brush.px(1.5));
}

void draw_objects(const Overlay& over) {
  const Brush& brush = over.brush;
  for (const MovingObject& object : over.report.frame.objects) {
    if (object.points == 0) continue;
    const auto [low, high] = over.box(object);
    // Show the effect of a click before the next frame comes, and while the film is paused.
    const std::optional<uint32_t>& requested = over.picture.requested;
    const bool is_felt =
        requested.value_or(0) != 0 ? *requested == object.id : over.is_felt(object.id);
    const float rounding = brush.px(4);
    if (is_felt) {
      brush.list.AddRect(im(low), im(high), IM_COL32(0, 0, 0, 130), rounding, 0, brush.px(5));
    }
    brush.list.AddRect(im(low), im(high), is_felt ? kFeltColor : kOtherColor, rounding, 0,
                       brush.px(is_felt ? 2.5 : 1));
    if (!is_felt && !over.picture.detail) continue;
    const bool is_chosen = is_felt && (requested ? *requested != 0 : over.report.click != 0);
    const std::string name = "#" + std::to_string(object.id) + (is_chosen ? ", chosen" : "");
    const ImFont* font = brush.fonts.small;
    // Above the box, or within it at the upper edge of the picture.
    const double height = font->FontSize + brush.px(7);
    const double y = low.y() - height >= over.map.shown.y ? low.y() - height : low.y() + 2;
    draw_label(brush, font, im(low.x(), y), is_felt ? kFeltColor : kMutedColor, name);
  }
}

/// Writes the newtons of a force and its name `which` beside `beyond`, in the direction `along`,
/// moved so that the text fits into the panel.
void draw_size(const Overlay& over, double force_N, const char* which,
               const Eigen::Vector2d& beyond, const Eigen::Vector2d& along) {
  if (force_N < kFeltForce_N) return;
  const std::string text = formatted("%.1f N%s", force_N, which);
  const ImFont* font = over.brush.fonts.bold;
  const Eigen::Vector2d size(text_size(font, text).x + over.brush.px(10),
                             font->FontSize + over.brush.px(4));
  const Eigen::Vector2d middle =
      beyond + along.cwiseProduct(size / 2 + Eigen::Vector2d(6, 6) * over.brush.scale);
  const Rect& shown = over.map.shown;
  const Eigen::Vector2d low(shown.x, shown.y);
  const Eigen::Vector2d most =
      (low + Eigen::Vector2d(shown.width, shown.height) - size).cwiseMax(low);
  draw_label(over.brush, font, im((middle - size / 2).cwiseMax(low).cwiseMin(most)), kTextColor,
             text);
}

/// Returns false when the force is too small for an arrow.
bool draw_force(const Overlay& over, const Wrench& wrench, double shown_N, const char* which,
                const Eigen::Vector2d& from_px, ArrowStyle style) {
  style.centre_px = from_px;
  const std::optional<Arrow> felt = felt_arrow(wrench, style);
  if (!felt) return false;
  draw_arrow(over.brush, *felt, IM_COL32(0, 0, 0, 255), over.brush.px(1.75));
  draw_arrow(over.brush, *felt, color_of(felt->color, 255));
  // The number is beyond the tip.
  draw_size(over, shown_N, which, felt->tip_px, (felt->tip_px - felt->tail_px).normalized());
  return true;
}

void draw_touch(const Overlay& over, const TouchMark& touch, const ArrowStyle& style) {
  const Brush& brush = over.brush;
  const Rect& shown = over.map.shown;
  const auto at = [&](const Eigen::Vector2d& position) {
    return Eigen::Vector2d(shown.x + position.x() * shown.width,
                           shown.y + position.y() * shown.height);
  };
  const auto ring_px = static_cast<float>(finger_radius_px(shown.height));
  const ImVec2 finger = im(at(touch.finger));
  brush.list.AddCircle(finger, ring_px, IM_COL32(0, 0, 0, 200), 0, ring_px / 2);
  brush.list.AddCircle(finger, ring_px, IM_COL32(255, 255, 255, 255), 0, ring_px / 4);
  if (!touch.touching) return;
  const Eigen::Vector2d proxy_px = at(touch.proxy);
  if (!draw_force(over, {touch.force_N, {}}, touch.force_N.norm(), "", proxy_px, style)) {
    const Eigen::Vector2d down(0, 1);
    draw_size(over, touch.force_N.norm(), "", proxy_px + 2 * ring_px * down, down);
  }
  const auto radius_px =
      static_cast<float>(proxy_radius_px(touch, style.max_force_N, shown.height));
  brush.list.AddCircleFilled(im(proxy_px), radius_px + ring_px / 8, IM_COL32(0, 0, 0, 255));
  brush.list.AddCircleFilled(im(proxy_px), radius_px, kFeltColor);
}

/// Turns the relief, which is as displayed, to the stored orientation, which the panel shows.
void draw_relief(const Brush& brush, const Rect& shown, const ShownPicture& picture,
                 const Orientation& turn) {
  const auto at = [&](double x, double y) { return im(turn.displayed_position({x, y})); };
  brush.list.AddImageQuad(picture.relief, upper_left(shown), im(shown.x + shown.width, shown.y),
                          lower_right(shown), im(shown.x, shown.y + shown.height), at(0, 0),
                          at(1, 0), at(1, 1), at(0, 1));
}

PictureMap map_of(const Rect& panel, const ShownPicture& picture, const DrawnFrame& report) {
  const PicturePart& visible = report.visible;
  return map_picture(panel, visible.x, visible.y, visible.width, visible.height,
                     picture.pixel_aspect);
}

bool has_picture(const ShownPicture& picture, const DrawnFrame& report) {
  return picture.texture && report.visible.width > 0 && report.visible.height > 0;
}

}  // namespace

Rect shown_rect(const Rect& panel, const ShownPicture& picture, const DrawnFrame& report) {
  return has_picture(picture, report) ? map_of(panel, picture, report).shown : Rect();
}

void draw_picture(const Brush& brush, const Rect& panel, const ShownPicture& picture,
                  const DrawnFrame& report) {
  brush.list.AddRectFilled(upper_left(panel), lower_right(panel), IM_COL32(10, 11, 14, 255),
                           brush.px(6));
  const PicturePart& visible = report.visible;
  if (!has_picture(picture, report)) {
    draw_text(brush, brush.fonts.body, im(panel.x + 12 * brush.scale, panel.y + 10 * brush.scale),
              kMutedColor, "No frame yet");
    return;
  }
  const PictureMap map = map_of(panel, picture, report);
  const double w = picture.frame_width, h = picture.frame_height;
  brush.list.AddImage(picture.texture, upper_left(map.shown), lower_right(map.shown),
                      im(visible.x / w, visible.y / h),
                      im((visible.x + visible.width) / w, (visible.y + visible.height) / h));
  if (picture.relief) draw_relief(brush, map.shown, picture, report.turn);
  brush.list.PushClipRect(upper_left(map.shown), lower_right(map.shown), true);
  ArrowStyle style;
  style.scale = picture.arrow_scale;
  style.height_px = map.shown.height;
  style.max_force_N = picture.max_force_N;
  style.turn = report.turn;
  const Overlay over{brush, map, report, picture};
  if (report.has_area()) draw_area(over);
  draw_motion_of_points(over, style);
  if (picture.detail) draw_new_and_lost(over);
  draw_objects(over);
  const Eigen::Vector2d from_px = map(force_origin_px(report));
  const Wrench& wanted = report.frame.wrench;
  draw_force(over, wanted, picture.delivered_N.value_or(wanted.force_N.norm()),
             picture.delivered_N ? "" : " wanted", from_px, style);
  if (picture.touch) draw_touch(over, *picture.touch, style);
  brush.list.PopClipRect();
}

void draw_keys(const Brush& brush, const Rect& picture) {
  constexpr std::array<std::pair<const char*, const char*>, 10> kKeys{
      {{"space", "stops the force, and resumes it"},
       {"P", "pauses the film, or plays it"},
       {"left, right", "shorter or longer arrows"},
       {"up, down", "more or less force"},
       {"1, 2", "the first or the second of two settings"},
       {"C", "saves what was chosen by clicks"},
       {"D", "shows all detail"},
       {"S", "saves the window as a picture"},
       {"H", "shows these lines, and hides them"},
       {"Q", "closes the window; the film goes on"}}};
  const ImFont* font = brush.fonts.small;
  const double line = 1.6 * font->FontSize, margin = 12 * brush.scale;
  double names = 0, width = 0;
  for (const auto& [key, what] : kKeys) {
    names = std::max<double>(names, text_size(font, key).x);
    width = std::max<double>(width, text_size(font, what).x);
  }
  const double w = names + width + 3 * margin, h = kKeys.size() * line + 2 * margin;
  const double x = std::max(picture.x, picture.x + (picture.width - w) / 2);
  // The text stands in the middle, or below the switches.
  const double space = std::max(picture.height - h, 0.0);
  const double y = picture.y + (space / 2 < 44 * brush.scale ? space : space / 2);
  brush.list.AddRectFilled(im(x, y), im(x + w, y + h), IM_COL32(12, 14, 18, 225), brush.px(6));
  double at = y + margin;
  for (const auto& [key, what] : kKeys) {
    draw_text(brush, font, im(x + margin, at), kFeltColor, key);
    draw_text(brush, font, im(x + names + 2 * margin, at), kTextColor, what);
    at += line;
  }
}

void draw_hint(const Brush& brush, const Rect& picture, const std::string& line) {
  const ImFont* font = brush.fonts.small;
  const float margin = brush.px(8), inner = brush.px(4);
  const float most = static_cast<float>(picture.width) - 2 * (margin + inner);
  if (most <= 0) return;
  const ImVec2 size = font->CalcTextSizeA(font->FontSize, FLT_MAX, most, line.c_str());
  const ImVec2 at = im(picture.x + margin + inner, picture.bottom() - margin - inner - size.y);
  brush.list.AddRectFilled({at.x - inner, at.y - inner},
                           {at.x + size.x + inner, at.y + size.y + inner}, kLabelColor, inner);
  brush.list.AddText(font, font->FontSize, {std::round(at.x), std::round(at.y)}, kTextColor,
                     line.c_str(), nullptr, most);
}

}  // namespace spidar::window
