// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// All that a debug window shows, as plain data: no GL, no GObject.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/choice/feel_rules.h"
#include "core/force/motion_rendering.h"
#include "core/motion/scene_motion.h"
#include "plugin/filter/frame/scene_view.h"
#include "plugin/filter/frame/touch_view.h"
#include "plugin/output/device_view.h"

namespace spidar {

/// A property of the element that can be changed while it plays.
struct Setting {
  enum class Kind { kSwitch, kChoice, kWhole, kNumber };
  struct Choice {
    int value = 0;
    std::string name;
  };
  std::string name;
  std::string help;
  Kind kind = Kind::kNumber;
  double value = 0, low = 0, high = 0;
  std::vector<Choice> choices;
};

/// The element as it is now.
struct ElementState {
  std::string name;
  bool is_playing = false;           ///< its state is PLAYING
  std::optional<DeviceView> device;  ///< nothing with device=none or while it is closed
  std::vector<Setting> settings;
  std::string no_force;  ///< why there was none in the last second; empty: it is felt
  std::shared_ptr<const FeelRules> rules;  ///< of `feel`; null: there are none

  /// Null when there is none of this name.
  const Setting* setting(const std::string& setting_name) const;
  double value(const std::string& setting_name, double otherwise) const;
};

/// Where a frame is in its film.
struct FilmMoment {
  std::shared_ptr<const std::string> path;  ///< null or empty: it is from no file
  int64_t stream_ns = -1;                   ///< −1: not known
  /// When the scene began, or what was seen of it: at a cut, or after a seek.
  int64_t scene_ns = -1;
  int64_t length_ns = 0;  ///< of the film; 0: not known

  std::string name() const { return path ? *path : ""; }
  bool is_same_scene(const FilmMoment& other) const {
    return scene_ns == other.scene_ns && (path == other.path || name() == other.name());
  }
};

/// What one analysed frame adds to the picture itself.
struct FrameFacts {
  int64_t running_ns = 0;
  FilmMoment film;
  double interval_s = 0;  ///< since the frame before; 0: nothing to compare with
  double analysis_ms = 0;
  VisiblePart visible;
  SceneView scene;
  MotionKind motion = MotionKind::kObject;  ///< which motion is felt
  ControllerSettings controller;
  double speed_px_s = 0;  ///< that the controller was given, of the reference frame
  uint32_t click = 0;     ///< number of the click whose object is kept; 0: none
  TouchScene touch;
};

/// "felt", or "not felt: " and why, for the last line of the window. While the surface is felt also
/// that the device gets less stiffness than is set.
std::string felt_line(const ElementState& state, const TouchScene& touch = {});

/// Speed that the gain controller would be given for this motion (see render_motion()), px/s.
double controller_speed_px_s(const ImageMotion& motion, const AxisGains& gains, int frame_height);

}  // namespace spidar
