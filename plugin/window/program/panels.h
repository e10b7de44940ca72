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
#include "plugin/window/program/model/timeline.h"
#include "plugin/window/program/model/two_settings.h"
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
  ImTextureID relief{};  ///< light and shadow of what is touched, as the picture is shown; or none
  /// The object that was clicked and is not felt yet, or 0: the one that is felt is let go.
  std::optional<uint32_t> requested;
  bool detail = false;  ///< every point, new and lost points, all boxes; else they are faint
  /// The force that the hand gets, unless it differs from the force that the frame asks for.
  std::optional<double> delivered_N;
};
/// The part of the window that shows the visible part of the frame.
Rect shown_rect(const Rect& panel, const ShownPicture& picture, const DrawnFrame& report);
void draw_picture(const Brush& brush, const Rect& panel, const ShownPicture& picture,
                  const DrawnFrame& report);

/// Frame, strings (the thicker the harder they pull), the grip and its force. `is_as_asked`: the
/// picture has the same force, so that neither needs a name.
void draw_grip(const Brush& brush, const Rect& panel, const DeviceView& device, bool is_as_asked);
/// The tension of each string as a bar.
void draw_tensions(const Brush& brush, const Rect& panel, const DeviceView& device);

/// The axis fits what is felt.
void draw_force(const Brush& brush, const Rect& panel, const Timeline& timeline);
void draw_speed(const Brush& brush, const Rect& panel, const Timeline& timeline);
/// Also draws the curve of the settings that are not in use, if they differ.
void draw_gain(const Brush& brush, const Rect& panel, const Timeline& timeline,
               const ControllerSettings& controller, const TwoSettings& settings);

/// At the lower edge of the picture: what the mouse does.
void draw_hint(const Brush& brush, const Rect& picture, const std::string& line);

/// The user's actions on the choices.
struct TimelineActions {
  std::optional<FeelRule> removed;  ///< this one is to be removed
  std::optional<int64_t> seek_ns;   ///< the film is to go on from there
  bool toggles = false;             ///< the film is to play, or to pause
  bool saves = false;
};
/// The last minute, with a button that pauses the film, plays it, or plays it again. Below it the
/// film with its choices, which can be saved if there are some that are not.
TimelineActions draw_timeline(const Brush& brush, const Rect& panel, const Timeline& timeline,
                              const ElementState& state, const FilmStrip& strip, bool has_unsaved);

/// `note`: the window's message at the moment; may be empty.
void draw_status(const Brush& brush, const Rect& panel, const ElementState& state,
                 const DrawnFrame& report, const std::string& note);

/// Switches in the upper right corner of the picture.
void draw_switches(const Brush& brush, const Rect& picture, bool& detail, bool& keys);
/// What the keys do, over the picture.
void draw_keys(const Brush& brush, const Rect& picture);

/// The user's actions on the settings.
struct ControlsActions {
  std::vector<std::pair<std::string, double>> changes;  ///< by name
  std::optional<std::string> preset;
  std::optional<size_t> settings;  ///< which are to be in use, see TwoSettings::use()
  bool resets = false;
};
/// The button for rest, which stays in sight; the two settings, presets, and widgets for each
/// setting.
ControlsActions draw_controls(const Brush& brush, const Rect& panel, const ElementState& state,
                              const TwoSettings& settings);

/// Shows a tooltip of the widget drawn last above `panel`, so that it does not cover what is in it.
void explain_above(const Rect& panel, const char* text);

/// The mouse in the frame of the window that is drawn, from Dear ImGui.
Mouse read_mouse();
}  // namespace spidar::window
