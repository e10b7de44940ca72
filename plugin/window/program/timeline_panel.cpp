// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cstdio>

#include "plugin/window/program/panels.h"
#include "plugin/window/program/plot.h"

namespace spidar {
namespace {

constexpr ImGuiWindowFlags kBare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoNav;

std::string title_of(const Timeline& timeline) {
  if (!timeline.is_paused()) return "Last minute";
  char text[48];
  std::snprintf(text, sizeof text, "%.1f s earlier",
                timeline.moments().back().time_s - timeline.cursor_s());
  return text;
}

/// The largest force in each part of the width.
std::vector<PlotPoint> profile(const Timeline& timeline, double newest_s, size_t parts) {
  std::vector<PlotPoint> points;
  const double part_s = Timeline::kMemory_s / static_cast<double>(parts);
  double x = 0.5 * part_s - Timeline::kMemory_s;
  for (const ForceColumn& column :
       timeline.columns(newest_s - Timeline::kMemory_s, newest_s, parts)) {
    if (!column.is_empty) points.push_back({x, column.most_N});
    x += part_s;
  }
  return points;
}

/// In whole seconds.
std::string film_time(int64_t ns) {
  constexpr int64_t kSecond_ns = 1'000'000'000;
  return time_text(ns / kSecond_ns * kSecond_ns);
}

/// The part of the panel with the whole film.
constexpr double kStrip_px = 9, kLeastMark_px = 4;

Rect mark_rect(const Brush& brush, const Rect& place, const FilmStrip& strip,
               const StripMark& mark) {
  const double from = place.x + strip.share(mark.rule.from_ns) * place.width;
  const double to = place.x + strip.share(mark.rule.to_ns) * place.width;
  return {from, place.y, std::max(to - from, kLeastMark_px * brush.scale), place.height};
}

void draw_strip(const Brush& brush, const Rect& place, const FilmStrip& strip) {
  brush.list.AddRectFilled(upper_left(place), lower_right(place), kGridColor, brush.px(2));
  for (const StripMark& mark : strip.marks) {
    // A gap between two that follow each other.
    const Rect rect = mark_rect(brush, place, strip, mark).inset(0.5 * brush.scale);
    brush.list.AddRectFilled(upper_left(rect), lower_right(rect),
                             mark.is_new ? kFeltColor : kAccentColor, brush.px(2));
  }
  const double now = place.x + strip.share(strip.now_ns) * place.width;
  const double beyond = 2 * brush.scale;
  brush.list.AddLine(im(now, place.y - beyond), im(now, place.bottom() + beyond), kTextColor,
                     brush.px(2));
}

/// With the mouse over it.
std::optional<FeelRule> use_strip(const Brush& brush, const Rect& place, const FilmStrip& strip) {
  ImGui::SetCursorScreenPos(im(place.x, place.y - 2 * brush.scale));
  ImGui::InvisibleButton("film", im(place.width, place.height + 4 * brush.scale));
  if (!ImGui::IsItemHovered()) return std::nullopt;
  const double share = (ImGui::GetIO().MousePos.x - place.x) / place.width;
  const StripMark* const mark = strip.at(share, kLeastMark_px * brush.scale / place.width);
  if (!mark) {
    const auto at_ns = static_cast<int64_t>(share * static_cast<double>(strip.length_ns));
    ImGui::SetTooltip("%s. Marks: an object was chosen, or another rule holds",
                      film_time(at_ns).c_str());
    return std::nullopt;
  }
  ImGui::SetTooltip("%s%s. A click removes it.", rule_text(mark->rule).c_str(),
                    mark->is_new ? ", not saved" : "");
  return ImGui::IsItemClicked() ? std::optional(mark->rule) : std::nullopt;
}

}  // namespace

TimelineUse draw_timeline(const Brush& brush, const Rect& panel, Timeline& timeline,
                          double max_force_N, const FilmStrip& strip, bool has_unsaved) {
  const Rect left = draw_panel(brush, panel, title_of(timeline));
  const double button = std::min(96 * brush.scale, left.width / 3);
  const double margin = 10 * brush.scale;
  const double below = strip.length_ns > 0 ? (kStrip_px + 5) * brush.scale : 0;
  const Rect content{left.x + button + margin, panel.y + 4 * brush.scale,
                     std::max(left.width - button - margin, 1.0),
                     std::max(panel.height - 10 * brush.scale - below, 1.0)};
  const double newest_s = timeline.moments().empty() ? 0 : timeline.moments().back().time_s;
  const PlotAxis x = make_axis(-Timeline::kMemory_s, 0, Plot::steps_across(brush, content.width));
  const PlotAxis y =
      make_axis(0, std::max(max_force_N, 0.1), Plot::steps_up(brush, content.height));
  const Plot plot(brush, content, x, y, "s", "N");
  const std::vector<PlotPoint> force =
      profile(timeline, newest_s, static_cast<size_t>(std::max(plot.area().width / 2, 1.0)));
  plot.area(force, faded(kFeltColor, 60));
  plot.line(force, kFeltColor, 1.2);
  // What the plots below show.
  const double cursor = timeline.cursor_s() - newest_s;
  const double from = std::max(cursor - timeline.plotted_s(), -Timeline::kMemory_s);
  brush.list.AddRectFilled(plot.at(from, y.high), plot.at(cursor, y.low), faded(kTextColor, 28));
  plot.upright(cursor, timeline.is_paused() ? kTextColor : kLineColor);

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
  const bool paused = timeline.is_paused();
  if (ImGui::Button(paused ? "Live" : "Pause", im(button, 0))) {
    paused ? timeline.resume() : timeline.pause();
  }
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("Holds what the window shows (P). The video and the force continue.");
  }
  TimelineUse use;
  if (has_unsaved) {
    ImGui::SetCursorScreenPos(im(left.x, left.y + 28 * brush.scale));
    ImGui::PushFont(brush.fonts.small);
    use.saves = ImGui::Button("Save choices", im(button, 0));
    ImGui::PopFont();
    if (ImGui::IsItemHovered()) {
      ImGui::SetTooltip("Writes them as rules into the file beside the film (C)");
    }
  }
  ImGui::SetCursorScreenPos(upper_left(plot.area()));
  ImGui::InvisibleButton("scrub", im(plot.area().width, std::max(plot.area().height, 1.0)));
  if (ImGui::IsItemActive()) {
    const double share = (ImGui::GetIO().MousePos.x - plot.area().x) / plot.area().width;
    timeline.look_at(newest_s + (share - 1) * Timeline::kMemory_s);
  } else if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("Drag to look back");
  }
  if (strip.length_ns > 0) use.removed = use_strip(brush, film, strip);
  ImGui::End();
  return use;
}

}  // namespace spidar
