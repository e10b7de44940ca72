// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>

#include "plugin/window/program/panels.h"

namespace spidar {
namespace {

/// A range of more than this is dragged, by a hundredth of the value for each pixel.
constexpr double kSlidable = 1e6, kDragged = 0.01;
/// A range over more than this factor has a logarithmic slider.
constexpr double kWide = 100;
constexpr double kTooltip_px = 340, kNameShare = 0.4, kReset_px = 46;

/// True when it was moved.
template <typename Number>
bool number_widget(ImGuiDataType type, const char* format, Number low, Number high, Number& value) {
  const double range = static_cast<double>(high) - static_cast<double>(low);
  ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
  if (range > kSlidable) {
    const double size = std::max(std::fabs(static_cast<double>(value)), 1.0);
    return ImGui::DragScalar("##value", type, &value, static_cast<float>(kDragged * size), &low,
                             &high, format, flags);
  }
  if (low > 0 && static_cast<double>(high) / static_cast<double>(low) > kWide) {
    flags |= ImGuiSliderFlags_Logarithmic;
  }
  return ImGui::SliderScalar("##value", type, &value, &low, &high, format, flags);
}

bool choice_widget(const Setting& setting, double& value) {
  const auto chosen = static_cast<int>(std::lround(value));
  const auto current =
      std::find_if(setting.choices.begin(), setting.choices.end(),
                   [&](const Setting::Choice& choice) { return choice.value == chosen; });
  const char* shown = current == setting.choices.end() ? "" : current->name.c_str();
  if (!ImGui::BeginCombo("##value", shown)) return false;
  bool moved = false;
  for (const Setting::Choice& choice : setting.choices) {
    if (ImGui::Selectable(choice.name.c_str(), choice.value == chosen)) {
      value = choice.value;
      moved = true;
    }
  }
  ImGui::EndCombo();
  return moved;
}

bool value_widget(const Setting& setting, double& value) {
  switch (setting.kind) {
    case Setting::Kind::kSwitch: {
      bool on = value != 0;
      const bool moved = ImGui::Checkbox("##value", &on);
      value = on ? 1 : 0;
      return moved;
    }
    case Setting::Kind::kChoice:
      return choice_widget(setting, value);
    case Setting::Kind::kWhole: {
      auto whole = static_cast<int64_t>(std::llround(value));
      const bool moved = number_widget(ImGuiDataType_S64, "%lld", static_cast<int64_t>(setting.low),
                                       static_cast<int64_t>(setting.high), whole);
      value = static_cast<double>(whole);
      return moved;
    }
    case Setting::Kind::kNumber:
      break;
  }
  return number_widget(ImGuiDataType_Double, "%.4g", setting.low, setting.high, value);
}

void explain(const Brush& brush, const Setting& setting) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(brush.px(kTooltip_px));
  ImGui::TextUnformatted(setting.help.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

/// Whether it differs from the default by more than a slider rounds.
bool is_changed(const Setting& setting) {
  constexpr double kRounding = 1e-9;
  const double size = std::max(std::fabs(setting.value), std::fabs(setting.initial));
  return std::fabs(setting.value - setting.initial) > kRounding * size;
}

/// One row of the table: name, widget, and a button that takes it back to its default.
void draw_setting(const Brush& brush, const Setting& setting,
                  const std::function<void(const std::string&, double)>& set) {
  ImGui::PushID(setting.name.c_str());
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(setting.name.c_str());
  explain(brush, setting);
  ImGui::TableNextColumn();
  ImGui::SetNextItemWidth(-FLT_MIN);
  double value = setting.value;
  if (value_widget(setting, value) && value != setting.value) set(setting.name, value);
  explain(brush, setting);
  ImGui::TableNextColumn();
  if (is_changed(setting)) {
    ImGui::PushFont(brush.fonts.small);
    if (ImGui::Button("reset")) set(setting.name, setting.initial);
    ImGui::PopFont();
  }
  ImGui::PopID();
}

}  // namespace

void draw_controls(const Brush& brush, const Rect& panel, const ElementState& state,
                   const std::function<void(const std::string&, double)>& set) {
  ImGui::SetNextWindowPos(upper_left(panel));
  ImGui::SetNextWindowSize(im(panel.width, panel.height));
  ImGui::Begin("controls", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  const bool muted = state.value("mute", 0) != 0;
  ImGui::PushStyleColor(ImGuiCol_Button,
                        muted ? IM_COL32(46, 110, 66, 255) : IM_COL32(176, 48, 48, 255));
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered,
                        muted ? IM_COL32(56, 132, 80, 255) : IM_COL32(204, 60, 60, 255));
  ImGui::PushFont(brush.fonts.bold);
  if (ImGui::Button(muted ? "Resume force (space)" : "Stop force (space)", {-1, brush.px(30)})) {
    set("mute", muted ? 0 : 1);
  }
  ImGui::PopFont();
  ImGui::PopStyleColor(2);
  if (ImGui::BeginTable("settings", 3)) {
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed,
                            static_cast<float>(kNameShare * panel.width));
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("reset", ImGuiTableColumnFlags_WidthFixed, brush.px(kReset_px));
    for (const Setting& setting : state.settings) {
      if (setting.name != "mute") draw_setting(brush, setting, set);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

void draw_switches(const Brush& brush, const Rect& picture, bool& detail, bool* relief) {
  const float margin = brush.px(8);
  ImGui::SetNextWindowPos(
      {static_cast<float>(picture.right()) - margin, static_cast<float>(picture.y) + margin},
      ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowBgAlpha(0.8F);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {brush.px(8), brush.px(4)});
  // Else a box without a check cannot be seen on a picture.
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, brush.px(1.5));
  ImGui::Begin("switches", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PushStyleColor(ImGuiCol_Border, kTextColor);
  if (relief) {
    ImGui::Checkbox("Relief", relief);
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("The surface that is touched, over the picture (R)");
    ImGui::SameLine();
  }
  ImGui::Checkbox("Detail", &detail);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("All tracks, new and lost points, all objects (D)");
  ImGui::PopStyleColor();
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void draw_help(double scale) {
  ImGui::SetNextWindowPos(im(40 * scale, 40 * scale), ImGuiCond_Always);
  ImGui::Begin("Help", nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoInputs);
  constexpr const char* kRows[][2] = {
      {"Space", "takes the force to rest, and lets it return"},
      {"Left, right", "shorter or longer arrows"},
      {"Up, down", "more or less force"},
      {"D", "detail in the picture"},
      {"R", "the relief over the picture, while it is touched"},
      {"P", "pauses the window; the video and the force continue"},
      {", and .", "a tenth of a second back or forward, in a pause"},
      {"Wheel", "on force or speed: more or fewer seconds"},
      {"C", "saves the choices of objects as rules beside the film"},
      {"S", "saves the window as a PNG file in the current folder"},
      {"H", "this help"},
      {"Q", "closes the window; the video continues"},
      {"", ""},
      {"Left button", "held in the picture: the hand of the simulated device is there"},
      {"Wheel, Shift+drag", "the hand goes away from the viewer, or near"},
      {"", ""},
      {"Click on an object", "it is felt in this scene, or no more"},
      {"Click on a mark", "of the film below the last minute: removes this choice"},
      {"Outline", "an object; the thick one is felt"},
      {"White arrow", "the force as it pushes the hand"},
      {"Ring, disc", "the finger, and the point of the surface that it touches"},
      {"Small arrows", "where points went since the frame before; hue is direction"},
      {"Circle, red cross", "a new point, a lost point (detail)"},
      {"Bars", "tension of each string; the line is its smallest one"}};
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const auto& row : kRows) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(row[0]);
      ImGui::TableNextColumn();
      ImGui::TextDisabled("%s", row[1]);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace spidar
