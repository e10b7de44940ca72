// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/object_click.h"
#include "plugin/window/program/panels.h"

namespace spidar {
namespace {

constexpr ImU32 kRowColor = IM_COL32(34, 38, 47, 255), kOverColor = IM_COL32(54, 61, 76, 255);

const char* state_of(const ObjectRow& row) {
  if (!row.object->is_in_sight) return "hidden";
  if (row.is_chosen) return "chosen";
  return row.object->is_felt ? "felt" : "";
}

void draw_row(const Brush& brush, const Rect& place, const ObjectRow& row, bool is_over) {
  const ListedObject& object = *row.object;
  brush.list.AddRectFilled(upper_left(place), lower_right(place),
                           is_over && object.is_in_sight ? kOverColor : kRowColor, brush.px(4));
  const Rect picture = row_picture(place, row.aspect);
  const unsigned opacity = object.is_in_sight ? 255 : 90;
  if (row.picture) {
    brush.list.AddImage(row.picture, upper_left(picture), lower_right(picture), {0, 0}, {1, 1},
                        IM_COL32(255, 255, 255, opacity));
  }
  if (object.is_felt) {
    brush.list.AddRect(upper_left(place), lower_right(place), kFeltColor, brush.px(4), 0,
                       brush.px(row.is_chosen ? 2.5 : 1.2));
  }
  const std::string state = state_of(row);
  const ImFont *name = brush.fonts.bold, *small = brush.fonts.small;
  const double x = row_picture(place, 4.0 / 3).right() + 6 * brush.scale;
  const double lines = name->FontSize + (state.empty() ? 0 : small->FontSize);
  const double y = place.y + (place.height - lines) / 2;
  brush.list.PushClipRect(upper_left(place), lower_right(place), true);
  draw_text(brush, name, im(x, y), object.is_in_sight ? kTextColor : kMutedColor,
            short_name(object.id));
  draw_text(brush, small, im(x, y + name->FontSize), object.is_felt ? kFeltColor : kMutedColor,
            state);
  brush.list.PopClipRect();
}

const char* why_none(const FrameFacts& facts) {
  switch (facts.motion) {
    case MotionKind::kMean:
      return "None: motion=mean knows no objects";
    case MotionKind::kCamera:
      return "None: motion=camera looks for none";
    case MotionKind::kObject:
    case MotionKind::kObjects:
      break;
  }
  return "Nothing moves by itself";
}

}  // namespace

void draw_objects(const Brush& brush, const Rect& panel, const std::vector<ObjectRow>& rows,
                  const FrameFacts& facts, const Eigen::Vector2d& mouse_px) {
  const std::vector<Rect> places = object_rows(panel, brush.scale, rows.size());
  std::string title = "Objects";
  if (places.size() < rows.size()) {
    title += " (" + std::to_string(places.size()) + " of " + std::to_string(rows.size()) + ")";
  }
  const Rect content = draw_panel(brush, panel, title);
  if (rows.empty()) {
    draw_text(brush, brush.fonts.small, upper_left(content), kMutedColor, why_none(facts));
  }
  for (size_t i = 0; i < places.size(); ++i) {
    draw_row(brush, places[i], rows[i], offers_choice(facts) && places[i].has(mouse_px));
  }
}

bool draw_save_button(const Brush& brush, const Rect& panel) {
  const float margin = brush.px(4);
  ImGui::SetNextWindowPos(
      {static_cast<float>(panel.right()) - margin, static_cast<float>(panel.y) + margin},
      ImGuiCond_Always, {1, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleColor(ImGuiCol_Button, faded(kAccentColor, 150));
  ImGui::PushFont(brush.fonts.small);
  ImGui::Begin("save", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBackground);
  const bool is_pressed = ImGui::Button("Save choices");
  const bool is_over = ImGui::IsItemHovered();
  ImGui::End();
  ImGui::PopFont();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
  if (is_over) ImGui::SetTooltip("Writes them as rules into the file beside the film (C)");
  return is_pressed;
}

}  // namespace spidar
