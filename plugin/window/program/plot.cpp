// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/plot.h"

#include <algorithm>

namespace spidar::window {
namespace {

constexpr double kStepAcross_px = 56, kStepUp_px = 17;
constexpr double kGap_px = 5;

}  // namespace

Plot::Plot(const Brush& brush, const Rect& panel, const PlotAxis& x, const PlotAxis& y,
           const std::string& x_unit, const std::string& y_unit)
    : brush_(brush), area_(panel), x_(x), y_(y) {
  double widest = 0;
  for (const double tick : y_.ticks()) {
    widest = std::max<double>(widest, text_size(brush.fonts.small, y_.label(tick)).x);
  }
  const double gap = kGap_px * brush.scale, text = brush.fonts.small->FontSize;
  const double left = std::min(widest + gap, area_.width);
  const double below = std::min(text + gap, area_.height);
  // The unit of y needs space above; half of the last label needs space on the right.
  const double above = std::min(text + gap, area_.height - below);
  area_ = {area_.x + left, area_.y + above, std::max(area_.width - left - 2 * gap, 1.0),
           std::max(area_.height - above - below, 1.0)};
  unit_width_ = text_size(brush.fonts.small, y_unit).x;
  draw_axes(x_unit, y_unit);
}

void Plot::draw_axes(const std::string& x_unit, const std::string& y_unit) const {
  const ImFont* font = brush_.fonts.small;
  const float gap = brush_.px(kGap_px), half = font->FontSize / 2;
  for (const double tick : y_.ticks()) {
    const ImVec2 left = at(x_.low, tick);
    brush_.list.AddLine(left, at(x_.high, tick), tick == 0 ? kLineColor : kGridColor);
    draw_text_before(brush_, font, {left.x - gap, left.y - half}, kMutedColor, y_.label(tick));
  }
  const bool has_room = text_size(font, y_unit).x <= area_.width;
  draw_text(brush_, font, im(area_.x, area_.y - font->FontSize - gap), kMutedColor,
            has_room ? y_unit : y_unit.substr(0, y_unit.find(' ')));
  const float unit_x = static_cast<float>(area_.right()) - text_size(font, x_unit).x;
  float free_x = 0;  // to the right of the previous labels
  std::string last = x_unit;
  for (const double tick : x_.ticks()) {
    const ImVec2 low = at(tick, y_.low);
    brush_.list.AddLine(low, at(tick, y_.high), kGridColor);
    const std::string label = x_.label(tick);
    const float width = text_size(font, label).x;
    // If there is no space beside the unit for the last label, the label is placed before the unit.
    if (low.x + width / 2 + gap > unit_x) {
      if (unit_x - width - gap > free_x) last = label + " " + x_unit;
      continue;
    }
    draw_text(brush_, font, {low.x - width / 2, low.y + gap / 2}, kMutedColor, label);
    free_x = low.x + width / 2 + gap;
  }
  draw_text_before(brush_, font, im(area_.right(), area_.bottom() + gap / 2), kMutedColor, last);
}

ImVec2 Plot::at(double x, double y) const {
  return im(area_.x + x_.fraction(x) * area_.width, area_.bottom() - y_.fraction(y) * area_.height);
}

void Plot::line(const std::vector<Eigen::Vector2d>& points, ImU32 color, double width_px) const {
  std::vector<ImVec2> corners;
  corners.reserve(points.size());
  const float mark = brush_.px(4);
  brush_.list.PushClipRect(upper_left(area_), lower_right(area_), true);
  for (const Eigen::Vector2d& point : points) {
    // Far beyond the range coordinates would lose their precision.
    const double fraction = std::clamp(y_.fraction(point.y()), -1.0, 2.0);
    corners.push_back(at(point.x(), y_.low + fraction * (y_.high - y_.low)));
    if (point.y() <= y_.high) continue;
    const ImVec2 top = at(point.x(), y_.high);
    brush_.list.AddTriangleFilled(top, {top.x + mark, top.y + 1.5F * mark},
                                  {top.x - mark, top.y + 1.5F * mark}, color);
  }
  brush_.list.AddPolyline(corners.data(), static_cast<int>(corners.size()), color, 0,
                          brush_.px(width_px));
  brush_.list.PopClipRect();
}

void Plot::band(const std::vector<PlotSpan>& spans, ImU32 color, double width_px) const {
  const double part = (x_.high - x_.low) / static_cast<double>(std::max<size_t>(spans.size(), 1));
  const float least = brush_.px(width_px);
  std::vector<Eigen::Vector2d> middles;
  const auto end_line = [&] {
    line(middles, color, width_px);
    middles.clear();
  };
  for (size_t i = 0; i < spans.size(); ++i) {
    const PlotSpan& span = spans[i];
    if (span.is_empty) {
      end_line();
      continue;
    }
    const double x = x_.low + part * static_cast<double>(i);
    const ImVec2 high = at(x, std::clamp(span.high, y_.low, y_.high));
    const ImVec2 low = at(x + part, std::clamp(span.low, y_.low, y_.high));
    if (low.y - high.y > least) brush_.list.AddRectFilled(high, low, color);
    middles.emplace_back(x + part / 2, (span.low + span.high) / 2);
  }
  end_line();
}

void Plot::upright(double x, ImU32 color) const {
  brush_.list.AddLine(at(x, y_.low), at(x, y_.high), color, brush_.px(1.5));
}

std::optional<double> Plot::hovered_x() const {
  if (ImGui::GetIO().WantCaptureMouse) return std::nullopt;
  if (!ImGui::IsMouseHoveringRect(upper_left(area_), lower_right(area_), false)) {
    return std::nullopt;
  }
  const double fraction = (ImGui::GetMousePos().x - area_.x) / area_.width;
  const double x = x_.low + fraction * (x_.high - x_.low);
  upright(x, kLineColor);
  return x;
}

void Plot::dot(double x, double y, ImU32 color) const {
  const ImVec2 centre = at(std::clamp(x, x_.low, x_.high), std::clamp(y, y_.low, y_.high));
  brush_.list.AddCircleFilled(centre, brush_.px(6), kPanelColor);
  brush_.list.AddCircleFilled(centre, brush_.px(4.5), color);
}

void Plot::legend(const std::vector<std::pair<const char*, ImU32>>& keys) const {
  const ImFont* font = brush_.fonts.small;
  const float gap = brush_.px(kGap_px), stroke = brush_.px(12);
  // The names stand to the right of the unit; the last ones are left out when there is no space.
  const float space = static_cast<float>(area_.width) - unit_width_ - 2 * gap;
  float width = 0;
  size_t count = 0;
  for (; count < keys.size(); ++count) {
    const float next = stroke + 3 * gap + text_size(font, keys[count].first).x;
    if (width + next - 2 * gap > space) break;
    width += next;
  }
  ImVec2 at = im(area_.right() - width + 2 * gap, area_.y - font->FontSize - gap);
  for (size_t i = 0; i < count; ++i) {
    const auto& [name, color] = keys[i];
    const float middle = at.y + font->FontSize / 2;
    brush_.list.AddLine({at.x, middle}, {at.x + stroke, middle}, color, brush_.px(2));
    at.x += stroke + gap;
    draw_text(brush_, font, at, kMutedColor, name);
    at.x += text_size(font, name).x + 2 * gap;
  }
}

int Plot::steps_across(const Brush& brush, double width_px) {
  return std::max(1, static_cast<int>(width_px / (kStepAcross_px * brush.scale)));
}

int Plot::steps_up(const Brush& brush, double height_px) {
  return std::max(1, static_cast<int>(height_px / (kStepUp_px * brush.scale)));
}

}  // namespace spidar::window
