// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cstdio>

#include "plugin/window/program/panels.h"

namespace spidar {

void draw_status(const Brush& brush, const Rect& panel, const ElementState& state,
                 const FrameFacts& facts, const std::string& note) {
  brush.list.AddRectFilled(upper_left(panel), lower_right(panel), kPanelColor, brush.px(6));
  brush.list.AddRect(upper_left(panel), lower_right(panel), kBorderColor, brush.px(6));
  brush.list.PushClipRect(upper_left(panel), lower_right(panel), true);
  const ImFont* font = brush.fonts.body;
  const ImFont* small = brush.fonts.small;
  const double middle = panel.y + panel.height / 2;
  const bool is_felt = state.no_force.empty();
  const ImU32 color = is_felt ? kGoodColor : kFeltColor;
  const float radius = brush.px(5);
  ImVec2 at = im(panel.x + 10 * brush.scale, middle);
  brush.list.AddCircleFilled({at.x + radius, at.y}, radius, note.empty() ? color : kAccentColor);
  at.x += 2 * radius + brush.px(7);
  const std::string said = note.empty() ? felt_line(state, facts.touch) : note;
  draw_text(brush, font, {at.x, at.y - font->FontSize / 2}, kTextColor, said);
  const double left = at.x + text_size(font, said).x + 16 * brush.scale;

  // From the right, as much as there is room for.
  std::vector<std::string> parts;
  char text[96];
  std::snprintf(text, sizeof text, "%.1f s", 1e-9 * static_cast<double>(facts.running_ns));
  parts.emplace_back(text);
  std::snprintf(text, sizeof text, "analysis %.1f ms", facts.analysis_ms);
  parts.emplace_back(text);
  parts.push_back(count_of(facts.scene.tracks.size(), "track"));
  parts.push_back(count_of(facts.scene.objects.size(), "object"));
  if (state.device) {
    const TickRecord& last = state.device->last;
    parts.push_back(std::string(to_string(last.device)) + (last.playing ? "" : ", not playing"));
    std::snprintf(text, sizeof text, "loop %.0f \xC2\xB5s late",
                  1e-3 * static_cast<double>(last.lateness_ns));
    parts.emplace_back(text);
    parts.push_back(count_of(state.device->overruns, "overrun"));
  }
  parts.emplace_back("H for help");
  double x = panel.right() - 10 * brush.scale;
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    const double width = text_size(small, *part).x;
    if (x - width < left) break;
    draw_text_before(brush, small, im(x, middle - small->FontSize / 2), kMutedColor, *part);
    x -= width + 16 * brush.scale;
  }
  brush.list.PopClipRect();
}

}  // namespace spidar
