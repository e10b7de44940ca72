// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>

#include "plugin/window/panels.h"

namespace spidar {
namespace {

/// A range of more than this many powers of ten, or one from zero far up, is dragged on a
/// logarithmic slider.
constexpr double kWide = 100;

/// True when it was moved.
bool number_widget(const Setting& setting, double& value) {
  ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
  if (setting.low > 0 && setting.high / setting.low > kWide) flags |= ImGuiSliderFlags_Logarithmic;
  // ImGui takes no slider over more than half of a double's range.
  const double low = std::max(setting.low, -1e300), high = std::min(setting.high, 1e300);
  if (setting.kind == Setting::Kind::kNumber) {
    return ImGui::SliderScalar(setting.name.c_str(), ImGuiDataType_Double, &value, &low, &high,
                               "%.4g", flags);
  }
  auto whole = static_cast<int64_t>(std::llround(value));
  const auto least = static_cast<int64_t>(low), most = static_cast<int64_t>(high);
  const bool moved = ImGui::SliderScalar(setting.name.c_str(), ImGuiDataType_S64, &whole, &least,
                                         &most, "%lld", flags);
  value = static_cast<double>(whole);
  return moved;
}

bool choice_widget(const Setting& setting, double& value) {
  const auto chosen = static_cast<int>(std::lround(value));
  const auto current =
      std::find_if(setting.choices.begin(), setting.choices.end(),
                   [&](const Setting::Choice& choice) { return choice.value == chosen; });
  const char* shown = current == setting.choices.end() ? "" : current->name.c_str();
  if (!ImGui::BeginCombo(setting.name.c_str(), shown)) return false;
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

bool widget(const Setting& setting, double& value) {
  switch (setting.kind) {
    case Setting::Kind::kSwitch: {
      bool on = value != 0;
      const bool moved = ImGui::Checkbox(setting.name.c_str(), &on);
      value = on ? 1 : 0;
      return moved;
    }
    case Setting::Kind::kChoice:
      return choice_widget(setting, value);
    case Setting::Kind::kWhole:
    case Setting::Kind::kNumber:
      break;
  }
  return number_widget(setting, value);
}

}  // namespace

void draw_controls(const Rect& panel, const ElementState& state,
                   const std::function<void(const std::string&, double)>& set) {
  ImGui::SetNextWindowPos(upper_left(panel));
  ImGui::SetNextWindowSize(im(panel.width, panel.height));
  ImGui::Begin("controls", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  const bool muted = state.value("mute", 0) != 0;
  ImGui::PushStyleColor(ImGuiCol_Button,
                        muted ? IM_COL32(60, 110, 60, 255) : IM_COL32(170, 40, 40, 255));
  if (ImGui::Button(
          muted ? "force is at rest: let it come back (space)" : "force to rest at once (space)",
          {-1, 0})) {
    set("mute", muted ? 0 : 1);
  }
  ImGui::PopStyleColor();
  ImGui::PushItemWidth(static_cast<float>(0.5 * panel.width));
  for (const Setting& setting : state.settings) {
    if (setting.name == "mute") continue;
    double value = setting.value;
    if (widget(setting, value) && value != setting.value) set(setting.name, value);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", setting.help.c_str());
  }
  ImGui::PopItemWidth();
  ImGui::End();
}

void draw_help(double scale) {
  ImGui::SetNextWindowPos(im(40 * scale, 40 * scale), ImGuiCond_Always);
  ImGui::Begin("help", nullptr,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoInputs);
  ImGui::TextUnformatted(
      "space       force to rest, and back\n"
      "left right  arrows shorter, longer\n"
      "up down     more, less force (max-force)\n"
      "s           save the window as PNG in the current folder\n"
      "h           this help\n"
      "q           close the window; the video goes on\n"
      "\n"
      "arrows      a track's way since the frame before, times arrow-scale;\n"
      "            hue is direction, bold is an object, pale the background\n"
      "circle      new point        red cross  lost point\n"
      "white       the force as it pushes the hand\n"
      "bars        tension of each string; the line is its smallest one");
  ImGui::End();
}

}  // namespace spidar
