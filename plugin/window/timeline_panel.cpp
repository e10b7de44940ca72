// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cstdio>

#include "plugin/window/panels.h"
#include "plugin/window/plot.h"

namespace spidar {
namespace {

constexpr ImGuiWindowFlags kBare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoNav;

std::string where(const Timeline& timeline) {
  if (!timeline.is_paused()) return "live";
  char text[48];
  std::snprintf(text, sizeof text, "%.1f s earlier",
                timeline.moments().back().time_s - timeline.cursor_s());
  return text;
}

/// The largest of each slot of the width: a minute has more moments than a panel has pixels.
std::vector<PlotPoint> profile(const Timeline& timeline, double newest_s, int slots) {
  std::vector<PlotPoint> points;
  const double slot_s = Timeline::kMemory_s / std::max(slots, 1);
  for (const Moment& moment : timeline.moments()) {
    const PlotPoint point{moment.time_s - newest_s, moment.felt_span.most_N};
    if (!points.empty() && point.x < points.back().x + slot_s) {
      points.back().y = std::max(points.back().y, point.y);
    } else {
      points.push_back(point);
    }
  }
  return points;
}

}  // namespace

void draw_timeline(const Brush& brush, const Rect& panel, Timeline& timeline, double max_force_N) {
  const Rect left = draw_panel(brush, panel, "Last minute");
  const double button = std::min(96 * brush.scale, left.width / 3);
  const double margin = 10 * brush.scale;
  const Rect content{left.x + button + margin, panel.y + 4 * brush.scale,
                     std::max(left.width - button - margin, 1.0),
                     std::max(panel.height - 10 * brush.scale, 1.0)};
  draw_text(brush, brush.fonts.small, im(left.x, left.y + 32 * brush.scale), kMutedColor,
            where(timeline));
  const double newest_s = timeline.moments().empty() ? 0 : timeline.moments().back().time_s;
  const PlotAxis x = make_axis(-Timeline::kMemory_s, 0, Plot::steps_across(brush, content.width));
  const PlotAxis y =
      make_axis(0, std::max(max_force_N, 0.1), Plot::steps_up(brush, content.height));
  const Plot plot(brush, content, x, y, "s", "N");
  const std::vector<PlotPoint> force =
      profile(timeline, newest_s, static_cast<int>(plot.area().width / 2));
  plot.area(force, faded(kFeltColor, 60));
  plot.line(force, kFeltColor, 1.2);
  // What the plots below show.
  const double cursor = timeline.cursor_s() - newest_s;
  const double from = std::max(cursor - timeline.plotted_s(), -Timeline::kMemory_s);
  brush.list.AddRectFilled(plot.at(from, y.high), plot.at(cursor, y.low), faded(kTextColor, 28));
  plot.upright(cursor, timeline.is_paused() ? kTextColor : kLineColor);

  ImGui::SetNextWindowPos(upper_left(panel));
  ImGui::SetNextWindowSize(im(panel.width, panel.height));
  ImGui::Begin("timeline", nullptr, kBare);
  ImGui::SetCursorScreenPos(im(left.x, left.y + 2 * brush.scale));
  const bool paused = timeline.is_paused();
  if (ImGui::Button(paused ? "Live" : "Pause", im(button, 0))) {
    paused ? timeline.resume() : timeline.pause();
  }
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("Holds what the window shows (P). The video and the force continue.");
  }
  ImGui::SetCursorScreenPos(upper_left(plot.area()));
  ImGui::InvisibleButton("scrub", im(plot.area().width, std::max(plot.area().height, 1.0)));
  if (ImGui::IsItemActive()) {
    const double share = (ImGui::GetIO().MousePos.x - plot.area().x) / plot.area().width;
    timeline.look_at(newest_s + (share - 1) * Timeline::kMemory_s);
  } else if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("Drag to look back");
  }
  ImGui::End();
}

}  // namespace spidar
