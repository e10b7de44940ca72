// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "plugin/window/program/panels.h"
#include "spidar/text.h"

namespace spidar::window {
namespace {

/// A slider is logarithmic if its range exceeds kMaxLinearRange, or if its default would be in the
/// first kFarLeft of it.
constexpr double kMaxLinearRange = 1e6, kFarLeft = 0.1;
constexpr double kTooltip_px = 340, kNameFraction = 0.4;
/// The space for a value to the right of its slider: "0.0025 s/px".
constexpr double kValue_px = 84;

/// "1 object", "2 objects".
std::string count_of(size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// Extracts the unit from the description of a property: "…, in Hz: …"; a factor has none.
const char* unit_of(const Setting& setting) {
  constexpr std::pair<const char*, const char*> kUnits[] = {{", in newtons per metre", " N/m"},
                                                            {", in newtons", " N"},
                                                            {", in s/px", " s/px"},
                                                            {", in Hz", " Hz"},
                                                            {", in millimetres", " mm"},
                                                            {", in nanoseconds", " ns"}};
  for (const auto& [words, unit] : kUnits) {
    if (setting.help.find(words) != std::string::npos) return unit;
  }
  return "";
}

/// Returns true when the slider was moved. The value is shown beside the slider, because the handle
/// would be drawn over a value inside; only a value that is being typed is inside.
bool number_widget(const Brush& brush, const Setting& setting, double& value) {
  const double range = setting.high - setting.low;
  const bool is_far_left = setting.low >= 0 && setting.usual - setting.low < kFarLeft * range;
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp |
      (range > kMaxLinearRange || is_far_left ? ImGuiSliderFlags_Logarithmic : 0);
  const char* const format = setting.kind == Setting::Kind::kWhole ? "%.0f" : "%.4g";
  const bool is_typing = ImGui::GetIO().WantTextInput;
  ImGui::BeginGroup();
  ImGui::SetNextItemWidth(-brush.px(kValue_px));
  if (!is_typing) ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32_BLACK_TRANS);
  const bool moved = ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &setting.low,
                                         &setting.high, format, flags);
  if (!is_typing) ImGui::PopStyleColor();
  ImGui::SameLine();
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  ImGui::TextUnformatted((text + std::string(unit_of(setting))).c_str());
  ImGui::EndGroup();
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

bool value_widget(const Brush& brush, const Setting& setting, double& value) {
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
  return number_widget(brush, setting, value);
}

/// Shows the help of the hovered setting to the left of `panel`, where it covers no widget.
void explain(const Brush& brush, const Rect& panel, const Setting& setting) {
  if (!ImGui::IsItemHovered()) return;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const bool is_low = low.y > ImGui::GetIO().DisplaySize.y / 2;
  ImGui::SetNextWindowPos({static_cast<float>(panel.x) - brush.px(4), is_low ? high.y : low.y},
                          ImGuiCond_Always, {1, is_low ? 1.0F : 0.0F});
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(brush.px(kTooltip_px));
  ImGui::TextUnformatted(setting.help.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void draw_setting(const Brush& brush, const Rect& panel, const Setting& setting,
                  ControlsActions& actions) {
  ImGui::PushID(setting.name.c_str());
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(setting.name.c_str());
  explain(brush, panel, setting);
  ImGui::TableNextColumn();
  ImGui::SetNextItemWidth(-FLT_MIN);
  double value = setting.value;
  if (value_widget(brush, setting, value) && value != setting.value) {
    actions.changes.emplace_back(setting.name, value);
  }
  explain(brush, panel, setting);
  ImGui::PopID();
}

/// Whether a setting is for viewers; the others are for people who know the element.
bool is_basic(const Setting& setting) {
  constexpr std::array<const char*, 4> kNames{"motion", "max-force", "alpha", "touch"};
  return std::find(kNames.begin(), kNames.end(), setting.name) != kNames.end();
}

void draw_table(const Brush& brush, const Rect& panel, const ElementState& state, bool of_viewer,
                ControlsActions& actions) {
  if (!ImGui::BeginTable(of_viewer ? "settings" : "advanced", 2)) return;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed,
                          static_cast<float>(kNameFraction * panel.width));
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
  for (const Setting& setting : state.settings) {
    if (setting.name == "mute" || is_basic(setting) != of_viewer) continue;
    draw_setting(brush, panel, setting, actions);
  }
  ImGui::EndTable();
}

void draw_stop(const Brush& brush, const ElementState& state, ControlsActions& actions) {
  const bool muted = state.value("mute", 0) != 0;
  ImGui::PushStyleColor(ImGuiCol_Button,
                        muted ? IM_COL32(46, 110, 66, 255) : IM_COL32(176, 48, 48, 255));
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered,
                        muted ? IM_COL32(56, 132, 80, 255) : IM_COL32(204, 60, 60, 255));
  ImGui::PushFont(brush.fonts.bold);
  if (ImGui::Button(muted ? "Resume force (space)" : "Stop force (space)", {-1, brush.px(30)})) {
    actions.changes.emplace_back("mute", muted ? 0 : 1);
  }
  ImGui::PopFont();
  ImGui::PopStyleColor(2);
}

/// Draws the two settings, a button that undoes all changes, and the presets.
void draw_choices(const Brush& brush, const Rect& panel, const ElementState& state,
                  const SettingsComparison& settings, ControlsActions& actions) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Compare");
  for (const size_t which : {size_t{0}, size_t{1}}) {
    ImGui::SameLine();
    const bool is_used = settings.used() == which;
    if (is_used) ImGui::PushStyleColor(ImGuiCol_Button, kAccentColor);
    if (ImGui::Button(which == 0 ? "1" : "2", {brush.px(26), 0})) actions.settings = which;
    if (is_used) ImGui::PopStyleColor();
    explain_above(panel,
                  "Two settings to compare, also by the keys 1 and 2: each keeps its changes");
  }
  const float reset = ImGui::CalcTextSize("Reset").x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::SameLine(ImGui::GetContentRegionMax().x - reset);
  actions.resets = ImGui::Button("Reset");
  explain_above(panel, "All settings as they were when the window was opened");
  ImGui::SetNextItemWidth(-FLT_MIN);
  if (ImGui::BeginCombo("##preset", "Presets")) {
    for (const std::string& preset : state.presets) {
      if (ImGui::Selectable(preset.c_str())) actions.preset = preset;
    }
    ImGui::EndCombo();
  }
}

}  // namespace

void explain_above(const Rect& panel, const char* text) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::SetNextWindowPos({ImGui::GetItemRectMin().x, static_cast<float>(panel.y)},
                          ImGuiCond_Always, {0, 1});
  ImGui::SetTooltip("%s", text);
}

ControlsActions draw_controls(const Brush& brush, const Rect& panel, const ElementState& state,
                              const SettingsComparison& settings) {
  constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                      ImGuiWindowFlags_NoSavedSettings;
  ControlsActions actions;
  ImGui::SetNextWindowPos(upper_left(panel));
  ImGui::SetNextWindowSize(im(panel.width, panel.height));
  ImGui::Begin("controls", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar);
  draw_stop(brush, state, actions);
  draw_choices(brush, panel, state, settings, actions);
  // The part below scrolls.
  ImGui::BeginChild("scrolled");
  draw_table(brush, panel, state, true, actions);
  if (ImGui::CollapsingHeader("Advanced")) draw_table(brush, panel, state, false, actions);
  ImGui::EndChild();
  ImGui::End();
  return actions;
}

void draw_switches(const Brush& brush, const Rect& picture, bool& detail, bool& keys) {
  const float margin = brush.px(8);
  ImGui::SetNextWindowPos(
      {static_cast<float>(picture.right()) - margin, static_cast<float>(picture.y) + margin},
      ImGuiCond_Always, {1, 0});
  ImGui::SetNextWindowBgAlpha(0.8F);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {brush.px(8), brush.px(4)});
  // Without a border, an empty check box cannot be seen on a picture.
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, brush.px(1.5));
  ImGui::Begin("switches", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PushStyleColor(ImGuiCol_Border, kTextColor);
  ImGui::Checkbox("Detail", &detail);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("All points, new and lost points, all objects (D)");
  ImGui::SameLine();
  ImGui::Checkbox("Keys", &keys);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("What the keys do (H)");
  ImGui::PopStyleColor();
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void draw_status(const Brush& brush, const Rect& panel, const ElementState& state,
                 const DrawnFrame& report, const std::string& note) {
  brush.list.AddRectFilled(upper_left(panel), lower_right(panel), kPanelColor, brush.px(6));
  brush.list.AddRect(upper_left(panel), lower_right(panel), kBorderColor, brush.px(6));
  brush.list.PushClipRect(upper_left(panel), lower_right(panel), true);
  const ImFont* font = brush.fonts.body;
  const ImFont* small = brush.fonts.small;
  const double middle = panel.y + panel.height / 2;
  const Wrench& now = state.device ? state.device->last.delivered : report.frame.wrench;
  const bool is_felt = state.no_force.empty() && size_N(now) >= kFeltForce_N;
  const ImU32 color = is_felt ? kGoodColor : state.no_force.empty() ? kMutedColor : kFeltColor;
  const float radius = brush.px(5);
  ImVec2 at = im(panel.x + 10 * brush.scale, middle);
  brush.list.AddCircleFilled({at.x + radius, at.y}, radius, note.empty() ? color : kAccentColor);
  at.x += 2 * radius + brush.px(7);
  const std::string said = note.empty() ? felt_line(state, report.touch, now) : note;
  const float space = static_cast<float>(panel.right()) - brush.px(10) - at.x;
  if (text_size(font, said).x <= space) {
    draw_text(brush, font, {at.x, at.y - font->FontSize / 2}, kTextColor, said);
  } else {
    draw_wrapped(brush, small, at, kTextColor, said, space);
  }
  const double left = at.x + text_size(font, said).x + 16 * brush.scale;

  // Draws from the right, as much as fits.
  std::vector<std::string> parts;
  parts.push_back(formatted("%.1f s", 1e-9 * static_cast<double>(report.stamp.running_ns)));
  if (!report.track) {
    parts.push_back(
        formatted("analysis %.1f ms a frame", 1e-6 * static_cast<double>(report.took_ns)));
    parts.push_back(count_of(report.frame.objects.size(), "object"));
  }
  if (state.device) {
    const TickRecord& last = state.device->last;
    parts.push_back(std::string("device ") + to_string(last.device) +
                    (last.playing ? "" : ", film at rest"));
    // Of a thousand forces a second, some are late on every machine that does other things.
    if (state.device->overruns > 0) parts.push_back(count_of(state.device->overruns, "late force"));
  }
  double x = panel.right() - 10 * brush.scale;
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    const double width = text_size(small, *part).x;
    if (x - width < left) break;
    draw_text_before(brush, small, im(x, middle - small->FontSize / 2), kMutedColor, *part);
    x -= width + 16 * brush.scale;
  }
  brush.list.PopClipRect();
}

}  // namespace spidar::window
