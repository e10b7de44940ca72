// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>

#include "plugin/window/program/panels.h"
#include "plugin/window/program/plot.h"

namespace spidar::window {
namespace {

constexpr ImGuiWindowFlags kBare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoNav;

/// The largest force in each part of the width.
std::vector<Eigen::Vector2d> profile(const Timeline& timeline, size_t parts) {
  std::vector<Eigen::Vector2d> points;
  const double whole_s = timeline.remembered_s();
  const double part_s = whole_s / static_cast<double>(parts);
  double x = 0.5 * part_s - whole_s;
  for (const ForceColumn& column :
       timeline.columns(timeline.newest_s() - whole_s, timeline.newest_s(), parts)) {
    if (!column.is_empty) points.emplace_back(x, column.most_N);
    x += part_s;
  }
  return points;
}

/// Shows the largest force beside the mouse.
void show_force_tooltip(const Plot& plot, const std::vector<Eigen::Vector2d>& force) {
  const double x_px = ImGui::GetMousePos().x;
  const auto after = std::find_if(force.begin(), force.end(), [&](const Eigen::Vector2d& point) {
    return plot.at(point.x(), 0).x >= x_px;
  });
  if (after != force.end()) ImGui::SetTooltip("%.0f s: %.2f N", after->x(), after->y());
}

/// In whole seconds.
std::string film_time(int64_t ns) {
  constexpr int64_t kSecond_ns = 1'000'000'000;
  return time_text(ns / kSecond_ns * kSecond_ns);
}

constexpr double kStrip_px = 9, kMinMark_px = 4;  ///< the part of the panel with the whole film

Rect mark_rect(const Brush& brush, const Rect& position, const FilmStrip& strip,
               const StripMark& mark) {
  const double from = position.x + strip.fraction(mark.rule.from_ns) * position.width;
  const double to = position.x + strip.fraction(mark.rule.to_ns) * position.width;
  return {from, position.y, std::max(to - from, kMinMark_px * brush.scale), position.height};
}

void draw_strip(const Brush& brush, const Rect& position, const FilmStrip& strip) {
  brush.list.AddRectFilled(upper_left(position), lower_right(position), kGridColor, brush.px(2));
  for (const StripMark& mark : strip.marks) {
    // Leaves a gap between two successive marks.
    const Rect rect = mark_rect(brush, position, strip, mark).inset(0.5 * brush.scale);
    brush.list.AddRectFilled(upper_left(rect), lower_right(rect),
                             mark.is_new ? kFeltColor : kAccentColor, brush.px(2));
  }
  const double now = position.x + strip.fraction(strip.now_ns) * position.width;
  const double beyond = 2 * brush.scale;
  brush.list.AddLine(im(now, position.y - beyond), im(now, position.bottom() + beyond), kTextColor,
                     brush.px(2));
}

void use_strip(const Brush& brush, const Rect& position, const FilmStrip& strip,
               TimelineActions& actions) {
  ImGui::SetCursorScreenPos(im(position.x, position.y - 2 * brush.scale));
  ImGui::InvisibleButton("film", im(position.width, position.height + 4 * brush.scale));
  if (!ImGui::IsItemHovered()) return;
  const double fraction = (ImGui::GetIO().MousePos.x - position.x) / position.width;
  const StripMark* const mark = strip.at(fraction, kMinMark_px * brush.scale / position.width);
  if (!mark) {
    const auto at_ns = static_cast<int64_t>(fraction * static_cast<double>(strip.length_ns));
    ImGui::SetTooltip("A click plays from %s.", film_time(at_ns).c_str());
    if (ImGui::IsItemClicked()) actions.seek_ns = at_ns;
    return;
  }
  ImGui::SetTooltip("%s%s. A click removes it.", rule_text(mark->rule).c_str(),
                    mark->is_new ? ", not saved" : "");
  if (ImGui::IsItemClicked()) actions.removed = mark->rule;
}

}  // namespace

TimelineActions draw_timeline(const Brush& brush, const Rect& panel, const Timeline& timeline,
                              const ElementState& state, const FilmStrip& strip, bool has_unsaved) {
  const Rect left = draw_panel(brush, panel, "Last minute");
  const double button = std::min(96 * brush.scale, left.width / 3);
  const double margin = 10 * brush.scale;
  const double below = strip.length_ns > 0 ? (kStrip_px + 5) * brush.scale : 0;
  const Rect content{left.x + button + margin, panel.y + 4 * brush.scale,
                     std::max(left.width - button - margin, 1.0),
                     std::max(panel.height - 10 * brush.scale - below, 1.0)};
  const PlotAxis x =
      make_axis(-timeline.remembered_s(), 0, Plot::steps_across(brush, content.width));
  const std::vector<Eigen::Vector2d> force =
      profile(timeline, static_cast<size_t>(std::max(content.width / 2, 1.0)));
  double largest_N = 0;
  for (const Eigen::Vector2d& point : force) largest_N = std::max(largest_N, point.y());
  const PlotAxis y =
      make_axis(0, force_axis_end_N(largest_N), Plot::steps_up(brush, content.height));
  const Plot plot(brush, content, x, y, "s", "N");
  plot.line(force, kFeltColor);
  // The part that the plots below show.
  brush.list.AddRectFilled(plot.at(-timeline.plotted_s(), y.high), plot.at(0, y.low),
                           faded(kTextColor, 28));

  const Rect film{plot.area().x, content.bottom() + 3 * brush.scale, plot.area().width,
                  kStrip_px * brush.scale};
  if (strip.length_ns > 0) {
    draw_strip(brush, film, strip);
    const std::string time = film_time(strip.now_ns) + " / " + film_time(strip.length_ns);
    draw_text(brush, brush.fonts.small, im(left.x, film.y - 2 * brush.scale), kMutedColor, time);
  }

  ImGui::SetNextWindowPos(upper_left(panel));
  ImGui::SetNextWindowSize(im(panel.width, panel.height));
  ImGui::Begin("timeline", nullptr, kBare);
  ImGui::SetCursorScreenPos(im(left.x, left.y + 2 * brush.scale));
  TimelineActions actions;
  const char* const label = state.has_ended ? "Play again" : state.is_playing ? "Pause" : "Play";
  actions.toggles = ImGui::Button(label, im(button, 0));
  explain_above(panel, "Asks the player for it (P)");
  if (has_unsaved) {
    ImGui::SetCursorScreenPos(im(left.x, left.y + 28 * brush.scale));
    ImGui::PushFont(brush.fonts.small);
    actions.saves = ImGui::Button("Save choices", im(button, 0));
    ImGui::PopFont();
    explain_above(panel, "Writes them as rules into the file beside the film (C)");
  }
  ImGui::SetCursorScreenPos(upper_left(plot.area()));
  ImGui::InvisibleButton("force", im(plot.area().width, std::max(plot.area().height, 1.0)));
  if (ImGui::IsItemHovered()) show_force_tooltip(plot, force);
  if (strip.length_ns > 0) use_strip(brush, film, strip, actions);
  ImGui::End();
  return actions;
}

}  // namespace spidar::window
