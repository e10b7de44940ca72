// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <imgui.h>
#include <string>

#include "plugin/window/program/model/layout.h"

namespace spidar::window {

constexpr ImU32 kBackColor = IM_COL32(17, 19, 24, 255);
constexpr ImU32 kPanelColor = IM_COL32(26, 29, 36, 255);
constexpr ImU32 kBorderColor = IM_COL32(44, 49, 60, 255);
constexpr ImU32 kLabelColor = IM_COL32(12, 14, 18, 205);  ///< background of text on a picture
constexpr ImU32 kGridColor = IM_COL32(48, 53, 64, 255);
constexpr ImU32 kLineColor = IM_COL32(96, 104, 120, 255);
constexpr ImU32 kTextColor = IM_COL32(226, 230, 237, 255);
constexpr ImU32 kMutedColor = IM_COL32(154, 163, 178, 255);  ///< text of less weight
constexpr ImU32 kAccentColor = IM_COL32(64, 160, 255, 255);
constexpr ImU32 kFeltColor = IM_COL32(255, 190, 60, 255);
constexpr ImU32 kSpeedColor = IM_COL32(190, 150, 255, 255);
constexpr ImU32 kGoodColor = IM_COL32(92, 200, 120, 255);
constexpr ImU32 kWarnColor = IM_COL32(255, 96, 88, 255);
/// x, y, z of the device frame: right, up, towards the viewer.
constexpr ImU32 kAxisColors[3] = {IM_COL32(255, 112, 102, 255), IM_COL32(126, 211, 112, 255),
                                  IM_COL32(98, 160, 255, 255)};

constexpr const char* kAxisNames[3] = {"right", "up", "near"};

/// The same colour with the opacity `alpha` (0 … 255).
constexpr ImU32 faded(ImU32 color, unsigned alpha) {
  return (color & ~IM_COL32_A_MASK) | (alpha << IM_COL32_A_SHIFT);
}

struct Fonts {
  ImFont* body = nullptr;
  ImFont* bold = nullptr;
  ImFont* small = nullptr;  ///< for axes and labels
};

/// Loads DejaVu Sans where it is installed, else the font of Dear ImGui.
Fonts load_fonts(double scale);
void set_style(double scale);

struct Brush {
  ImDrawList& list;
  double scale;  ///< of text and lines
  const Fonts& fonts;

  float px(double at_scale_1) const { return static_cast<float>(at_scale_1 * scale); }
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

ImVec2 text_size(const ImFont* font, const std::string& text);
void draw_text(const Brush& brush, const ImFont* font, ImVec2 at, ImU32 color,
               const std::string& text);
/// Wraps lines at this width, around the height of `at`.
void draw_wrapped(const Brush& brush, const ImFont* font, ImVec2 at, ImU32 color,
                  const std::string& text, float width_px);
/// Draws text that ends at `at`.
void draw_text_before(const Brush& brush, const ImFont* font, ImVec2 at, ImU32 color,
                      const std::string& text);
/// Draws text on a dark rounded background, readable on any picture. `at` is its upper left corner.
void draw_label(const Brush& brush, const ImFont* font, ImVec2 at, ImU32 color,
                const std::string& text);

/// Draws background, border and title of a panel, with `note` at the right of the title. Returns
/// the space for its content.
Rect draw_panel(const Brush& brush, const Rect& panel, const std::string& title,
                const std::string& note = {});

}  // namespace spidar::window
