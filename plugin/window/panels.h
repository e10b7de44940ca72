// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The parts of a debug window, each drawn into its rectangle with Dear ImGui.
#pragma once

#include <functional>
#include <imgui.h>
#include <string>

#include "plugin/window/layout.h"
#include "plugin/window/window_model.h"

namespace spidar {

/// What a panel draws with.
struct Brush {
  ImDrawList& list;
  double scale;  ///< of text and lines
};

inline ImVec2 im(const Eigen::Vector2d& at_px) {
  return {static_cast<float>(at_px.x()), static_cast<float>(at_px.y())};
}
inline ImVec2 im(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y)};
}
inline ImVec2 upper_left(const Rect& rect) {
  return im(rect.x, rect.y);
}
inline ImVec2 lower_right(const Rect& rect) {
  return im(rect.right(), rect.bottom());
}

constexpr ImU32 kPanelColor = IM_COL32(30, 32, 36, 255);
constexpr ImU32 kLineColor = IM_COL32(90, 94, 102, 255);
constexpr ImU32 kTextColor = IM_COL32(222, 224, 228, 255);
constexpr ImU32 kBarColor = IM_COL32(64, 160, 255, 255);
constexpr ImU32 kWantedColor = IM_COL32(150, 150, 160, 255);
constexpr ImU32 kFeltColor = IM_COL32(255, 190, 60, 255);
constexpr ImU32 kSpeedColor = IM_COL32(110, 210, 130, 255);
constexpr ImU32 kWarnColor = IM_COL32(255, 90, 80, 255);

/// The picture (texture of the whole frame; 0: none yet) and its arrows.
struct ShownPicture {
  ImTextureID texture{};
  int frame_width = 0, frame_height = 0;
  double pixel_aspect = 1;
};
void draw_picture(const Brush& brush, const Rect& panel, const ShownPicture& picture,
                  const FrameFacts& facts, double arrow_scale, double max_force_N);

/// Frame, strings, grip, and tensions as bars; with no device a line that says so.
void draw_grip(const Brush& brush, const Rect& panel, const ElementState& state);

void draw_force(const Brush& brush, const Rect& panel, const MotionHistory& history,
                double max_force_N);
void draw_speed(const Brush& brush, const Rect& panel, const MotionHistory& history);
void draw_gain(const Brush& brush, const Rect& panel, const MotionHistory& history,
               const ControllerSettings& controller);

/// `note`: what the window has to say at the moment; may be empty.
void draw_status(const Brush& brush, const Rect& panel, const ElementState& state,
                 const FrameFacts& facts, const std::string& note);

/// Widgets for the settings of the element, the button for rest first.
void draw_controls(const Rect& panel, const ElementState& state,
                   const std::function<void(const std::string&, double)>& set);
void draw_help(double scale);

}  // namespace spidar
