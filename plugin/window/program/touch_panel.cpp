// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>

#include "plugin/window/program/model/relief_view.h"
#include "plugin/window/program/panels.h"
#include "plugin/window/program/plot.h"

namespace spidar {
namespace {

constexpr int kSectionPoints = 200;
/// Margin of the height axis beyond relief and grip.
constexpr double kMargin_mm = 1;

}  // namespace

void draw_section(const Brush& brush, const Rect& panel, const TouchScene& scene,
                  const TickRecord& tick) {
  const Rect content = draw_panel(brush, panel, "Under the finger", depth_line(scene, tick));
  if (!scene.relief) {
    draw_text(brush, brush.fonts.small, im(content.x + brush.px(6), content.y + brush.px(6)),
              kMutedColor, "No relief yet");
    return;
  }
  const Eigen::Vector3d& grip_m = tick.pose.position_m;
  std::vector<PlotPoint> line;
  double highest_mm = std::fabs(1e3 * grip_m.z());
  for (const Eigen::Vector2d& at_m : touched_section(*scene.relief, tick, kSectionPoints)) {
    line.push_back({1e3 * at_m.x(), 1e3 * at_m.y()});
    highest_mm = std::max(highest_mm, std::fabs(line.back().y));
  }
  const double half_mm = 500 * scene.relief->width_m();
  const double most_mm = highest_mm + kMargin_mm;
  const PlotAxis x = make_axis(-half_mm, half_mm, Plot::steps_across(brush, content.width));
  const PlotAxis y = make_axis(-most_mm, most_mm, Plot::steps_up(brush, content.height));
  const Plot plot(brush, content, x, y, "mm", "mm near");
  plot.line(line, kSpeedColor);
  const Eigen::Vector3d& proxy_m = tick.contact.proxy_m;
  const ImVec2 finger = plot.at(1e3 * grip_m.x(), 1e3 * grip_m.z());
  if (tick.contact.touching) {
    const ImVec2 proxy = plot.at(1e3 * proxy_m.x(), 1e3 * proxy_m.z());
    brush.list.AddLine(finger, proxy, kTextColor, brush.px(1.5));
    brush.list.AddCircleFilled(proxy, brush.px(4), kFeltColor);
  }
  brush.list.AddCircle(finger, brush.px(6), kTextColor, 0, brush.px(2));
}

void draw_hint(const Brush& brush, const Rect& picture, const std::string& line) {
  const ImFont* font = brush.fonts.small;
  const double margin = 8 * brush.scale;
  draw_label(brush, font,
             im(picture.x + margin, picture.bottom() - margin - font->FontSize - brush.px(4)),
             kTextColor, line);
}

}  // namespace spidar
