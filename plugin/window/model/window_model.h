// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// All that a debug window shows, as plain data: no GL, no GObject.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/analysis/motion_analyzer.h"
#include "core/analysis/no_force_reason.h"
#include "core/choice/feel_rules.h"
#include "plugin/device/device_view.h"
#include "plugin/frame/scene_view.h"
#include "plugin/frame/touch_view.h"

namespace spidar {

class Timeline;

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
  double initial = 0;  ///< the property's default
};

/// The element as it is now.
struct ElementState {
  std::string name;
  std::optional<DeviceView> device;  ///< nothing with device=none or while it is closed
  std::vector<Setting> settings;
  NoForceReason limit = NoForceReason::kNone;  ///< of the force in the last second
  std::shared_ptr<const FeelRules> rules;      ///< of `feel`; null: there are none

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
  AnalyzerSettings settings;
  TouchScene touch;
};

/// "1 object", "2 objects".
std::string count_of(size_t count, const std::string& noun);

/// Ids of the objects in sight whose motion is felt.
std::vector<uint32_t> felt_objects(const FrameFacts& facts);

/// "felt", or "not felt: " and why, for the last line of the window. While the surface is felt also
/// that the device gets less stiffness than is set.
std::string felt_line(const ElementState& state, const TouchScene& touch = {});

/// Speed that the gain controller would be given for this motion (see render_motion()), px/s.
double controller_speed_px_s(const ImageMotion& motion, const AxisGains& gains, int frame_height);

/// Force in N at `points` speeds from 0 to `highest_px_s`, of a controller that has learnt from
/// this timeline: the linear one all there is to know, the adaptive one what the plots show.
/// Empty when the settings are out of range.
std::vector<double> gain_curve(const ControllerSettings& settings, const Timeline& timeline,
                               double highest_px_s, int points);

}  // namespace spidar
