// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "plugin/window/program/model/setting_text.h"
#include "plugin/window/program/panels.h"

namespace spidar {
namespace {

/// A range of more than this many powers of ten, or one from zero far up, is dragged on a
/// logarithmic slider.
constexpr double kWide = 100;
constexpr double kLabelShare = 0.4, kResetWidth_px = 46, kTooltip_px = 340;
/// Of a number beside its slider, whose handle would cover it. A panel without room for that has
/// numbers that are dragged, and more room for names.
constexpr double kNumber_px = 72, kShortSlider_px = 68, kNarrow_px = 370, kNarrowLabelShare = 0.47;
/// Pixels from the lower end of a range to the upper one, and to another value half as large again.
constexpr double kDragged_px = 200, kHalfAgain_px = 25;

/// True when it was moved. `format` is that of its number.
template <typename Number>
bool slider(const Brush& brush, Number& shown, Number low, Number high, const std::string& format,
            ImGuiSliderFlags flags) {
  constexpr ImGuiDataType kType =
      std::is_floating_point_v<Number> ? ImGuiDataType_Double : ImGuiDataType_S64;
  const float room = ImGui::GetContentRegionAvail().x;
  if (room < brush.px(kNumber_px + kShortSlider_px)) {
    const double range = static_cast<double>(high) - static_cast<double>(low);
    const double size = std::max(std::fabs(static_cast<double>(shown)), 1.0);
    const double speed = std::min(range / kDragged_px, size / 2 / kHalfAgain_px);
    ImGui::SetNextItemWidth(-FLT_MIN);
    return ImGui::DragScalar("##value", kType, &shown, static_cast<float>(speed), &low, &high,
                             format.c_str(), flags);
  }
  ImGui::SetNextItemWidth(room - brush.px(kNumber_px));
  const bool moved = ImGui::SliderScalar("##value", kType, &shown, &low, &high, "", flags);
  ImGui::SameLine();
  ImGui::Text(format.c_str(), shown);
  return moved;
}

/// True when it was moved.
bool number_widget(const Brush& brush, const Setting& setting, const SettingText& text,
                   double& value) {
  ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
  if (setting.low > 0 && setting.high / setting.low > kWide) flags |= ImGuiSliderFlags_Logarithmic;
  // ImGui takes no slider over more than half of a double's range.
  const double low = std::max(setting.low, -1e300) / text.per_unit;
  const double high = std::min(setting.high, 1e300) / text.per_unit;
  const std::string unit = *text.unit ? std::string(" ") + text.unit : "";
  if (setting.kind == Setting::Kind::kNumber || text.per_unit != 1) {
    double shown = value / text.per_unit;
    const bool moved = slider(brush, shown, low, high, "%.4g" + unit, flags);
    value = shown * text.per_unit;
    return moved;
  }
  auto whole = static_cast<int64_t>(std::llround(value));
  const auto least = static_cast<int64_t>(low), most = static_cast<int64_t>(high);
  const bool moved = slider(brush, whole, least, most, "%lld" + unit, flags);
  value = static_cast<double>(whole);
  return moved;
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

bool value_widget(const Brush& brush, const Setting& setting, const SettingText& text,
                  double& value) {
  switch (setting.kind) {
    case Setting::Kind::kSwitch: {
      bool on = value != 0;
      const bool moved = ImGui::Checkbox("##value", &on);
      value = on ? 1 : 0;
      return moved;
    }
    case Setting::Kind::kChoice:
      return choice_widget(setting, value);
    case Setting::Kind::kWhole:
    case Setting::Kind::kNumber:
      break;
  }
  return number_widget(brush, setting, text, value);
}

void explain(const Brush& brush, const Setting& setting) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(brush.px(kTooltip_px));
  ImGui::PushFont(brush.fonts.bold);
  ImGui::TextUnformatted(setting.name.c_str());
  ImGui::PopFont();
  ImGui::TextUnformatted(setting.help.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

/// One row of the table: name, widget, and a button that takes it back to its default.
void draw_setting(const Brush& brush, const Setting& setting, const SettingText& text,
                  const std::function<void(const std::string&, double)>& set) {
  ImGui::PushID(setting.name.c_str());
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(text.label);
  explain(brush, setting);
  ImGui::TableNextColumn();
  ImGui::SetNextItemWidth(-FLT_MIN);
  double value = setting.value;
  if (value_widget(brush, setting, text, value) && value != setting.value) set(setting.name, value);
  explain(brush, setting);
  ImGui::TableNextColumn();
  if (is_changed(setting)) {
    ImGui::PushFont(brush.fonts.small);
    if (ImGui::Button("reset")) set(setting.name, setting.initial);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("Back to the default");
    ImGui::PopFont();
  }
  ImGui::PopID();
}

void draw_group(const Brush& brush, const Rect& panel, const ElementState& state,
                const SettingGroup& group,
                const std::function<void(const std::string&, double)>& set) {
  const auto is_there = [&](const SettingText& text) {
    return state.setting(text.property) != nullptr;
  };
  if (std::none_of(group.settings.begin(), group.settings.end(), is_there)) return;
  const auto differs = [&](const SettingText& text) {
    const Setting* const setting = state.setting(text.property);
    return setting && is_changed(*setting);
  };
  // A slider must not change its width while it is moved; a number that is dragged may.
  const bool narrow = panel.width < brush.px(kNarrow_px);
  const bool has_reset =
      !narrow || std::any_of(group.settings.begin(), group.settings.end(), differs);
  ImGui::Dummy({0, brush.px(2)});
  ImGui::PushFont(brush.fonts.bold);
  ImGui::TextUnformatted(group.name);
  ImGui::PopFont();
  ImGui::Separator();
  if (!ImGui::BeginTable(group.name, 3)) return;
  ImGui::TableSetupColumn(
      "name", ImGuiTableColumnFlags_WidthFixed,
      static_cast<float>((narrow ? kNarrowLabelShare : kLabelShare) * panel.width));
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("reset", ImGuiTableColumnFlags_WidthFixed,
                          has_reset ? brush.px(kResetWidth_px) : 1);
  for (const SettingText& text : group.settings) {
    if (const Setting* setting = state.setting(text.property)) {
      draw_setting(brush, *setting, text, set);
    }
  }
  ImGui::EndTable();
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
  for (const SettingGroup& group : setting_groups()) draw_group(brush, panel, state, group, set);
  ImGui::End();
}

void draw_switches(const Brush& brush, const Rect& picture, bool& detail, bool* relief) {
  const float margin = brush.px(8);
  ImGui::SetNextWindowPos(
      {static_cast<float>(picture.right()) - margin, static_cast<float>(picture.y) + margin},
      ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowBgAlpha(0.8F);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {brush.px(8), brush.px(4)});
  ImGui::Begin("switches", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  if (relief) {
    ImGui::Checkbox("Relief", relief);
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("The surface that is touched, over the picture (R)");
    ImGui::SameLine();
  }
  ImGui::Checkbox("Detail", &detail);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("All tracks, new and lost points, all objects (D)");
  ImGui::End();
  ImGui::PopStyleVar();
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
      {"Wheel, drag", "on force or speed: more or fewer seconds, earlier or later ones"},
      {"C", "saves the choices of objects as rules beside the film"},
      {"S", "saves the window as a PNG file in the current folder"},
      {"H", "this help"},
      {"Q", "closes the window; the video continues"},
      {"", ""},
      {"Left button", "held in the picture: the hand of the simulated device is there"},
      {"Wheel, Shift+drag", "the hand goes deeper into the picture, or nearer"},
      {"", ""},
      {"Click on an object", "in the picture or the list: it is felt in this scene, or no more"},
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
