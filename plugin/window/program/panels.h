// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The parts of a debug window, each drawn into its rectangle with Dear ImGui.
#pragma once

#include <imgui.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plugin/window/program/model/layout.h"
#include "plugin/window/program/model/scene_choices.h"
#include "plugin/window/program/model/settings_comparison.h"
#include "plugin/window/program/model/timeline.h"
#include "plugin/window/program/style.h"
#include "plugin/window/view/mouse_hand.h"
#include "plugin/window/view/window_view.h"

namespace spidar::window {

/// The picture (texture of the whole frame; 0: none yet) and what is drawn over it.
struct ShownPicture {
  ImTextureID texture{};
  int frame_width = 0, frame_height = 0;
  double pixel_aspect = 1;
  double arrow_scale = 1;
  double max_force_N = 0;
  std::optional<TouchMark> touch;
  /// Light and shadow of the touched relief, as the picture is shown; or none.
  ImTextureID relief{};
  /// The clicked object that is not felt yet; 0: the felt object is released.
  std::optional<uint32_t> requested;
  bool detail = false;  ///< every point, new and lost points, all boxes; otherwise they are faint
  /// The force that the hand gets, unless it differs from the force of the frame.
  std::optional<double> delivered_N;
};
/// The part of the window that shows the visible part of the frame.
Rect shown_rect(const Rect& panel, const ShownPicture& picture, const DrawnFrame& report);
void draw_picture(const Brush& brush, const Rect& panel, const ShownPicture& picture,
                  const DrawnFrame& report);

/// Draws frame, strings (thicker with more tension), the grip and its force. `is_as_asked` says
/// that the picture has the same force, so that neither needs a name.
void draw_grip(const Brush& brush, const Rect& panel, const DeviceView& device, bool is_as_asked);
void draw_tensions(const Brush& brush, const Rect& panel, const DeviceView& device);

void draw_force(const Brush& brush, const Rect& panel, const Timeline& timeline);
void draw_speed(const Brush& brush, const Rect& panel, const Timeline& timeline);
/// Also draws the curve of the settings that are not in use, if they differ.
void draw_gain(const Brush& brush, const Rect& panel, const Timeline& timeline,
               const ControllerSettings& controller, const SettingsComparison& settings);

/// Draws what the mouse does, at the lower edge of the picture.
void draw_hint(const Brush& brush, const Rect& picture, const std::string& line);

struct TimelineActions {
  std::optional<FeelRule> removed;  ///< the choice to remove
  std::optional<int64_t> seek_ns;   ///< where the film must continue
  bool toggles = false;             ///< whether the film must play, or pause
  bool saves = false;
};
/// Draws the last minute, with a button that pauses the film, plays it, or plays it again. Below is
/// the film with its choices, and a button to save new choices.
TimelineActions draw_timeline(const Brush& brush, const Rect& panel, const Timeline& timeline,
                              const ElementState& state, const FilmStrip& strip, bool has_unsaved);

/// `note` is the present message of the window; may be empty.
void draw_status(const Brush& brush, const Rect& panel, const ElementState& state,
                 const DrawnFrame& report, const std::string& note);

void draw_switches(const Brush& brush, const Rect& picture, bool& detail, bool& keys);
void draw_keys(const Brush& brush, const Rect& picture);

struct ControlsActions {
  std::vector<std::pair<std::string, double>> changes;  ///< by name
  std::optional<std::string> preset;
  std::optional<size_t> settings;  ///< the settings to use, see SettingsComparison::use()
  bool resets = false;
};
/// Draws the button that stops the force, which stays visible; the two settings, presets, and
/// widgets for each setting.
ControlsActions draw_controls(const Brush& brush, const Rect& panel, const ElementState& state,
                              const SettingsComparison& settings);

/// Shows a tooltip of the last widget above `panel`, so that it does not cover the content.
void explain_above(const Rect& panel, const char* text);

Mouse read_mouse();
}  // namespace spidar::window
