// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// All that a debug window shows, as plain data: no GL, no GObject.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/force/force_limit.h"
#include "core/motion_analyzer.h"
#include "plugin/device_view.h"
#include "plugin/overlay/scene_view.h"

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
  std::optional<DeviceView> device;  ///< nothing with device=none or while it is closed
  std::vector<Setting> settings;
  ForceLimit limit = ForceLimit::kNone;  ///< of the force in the last second

  /// Null when there is none of this name.
  const Setting* setting(const std::string& setting_name) const;
  double value(const std::string& setting_name, double otherwise) const;
};

/// What one analysed frame adds to the picture itself.
struct FrameFacts {
  int64_t running_ns = 0;
  double interval_s = 0;  ///< since the frame before; 0: nothing to compare with
  double analysis_ms = 0;
  VisiblePart visible;
  SceneView scene;
  AnalyzerSettings settings;
};

/// A moment of the plots.
struct Moment {
  double time_s = 0;
  double interval_s = 0;  ///< of the frame before, when a new one has come; 0 otherwise
  double speed_px_s = 0;  ///< of the reference frame, before the filter
  double wanted_N = 0;    ///< by the controller, of the newest frame
  double felt_N = 0;      ///< commanded by the loop, after safety
};

/// The last kMemory_s seconds, and the gain curve through them.
class MotionHistory {
 public:
  static constexpr double kMemory_s = 5;

  /// Moments in order of time; older ones than kMemory_s before it are forgotten.
  void add(const Moment& moment);
  const std::deque<Moment>& moments() const { return moments_; }

  /// Largest speed since the controller began to learn, for the linear one (eq. 13).
  double largest_speed_px_s() const { return largest_speed_px_s_; }
  void forget();

 private:
  std::deque<Moment> moments_;
  double largest_speed_px_s_ = 0;
};

/// "felt", or "not felt: " and why, for the last line of the window.
std::string felt_line(const ElementState& state);

/// Speed that the gain controller would be given for this motion (see render_motion()), px/s.
double controller_speed_px_s(const ImageMotion& motion, const AxisGains& gains, int frame_height);

/// Force in N at `points` speeds from 0 to `highest_px_s`, of a controller that has learnt from
/// this history: the linear one all there is to know, the adaptive one what kMemory_s seconds tell.
/// Empty when the settings are out of range.
std::vector<double> gain_curve(const ControllerSettings& settings, const MotionHistory& history,
                               double highest_px_s, int points);

}  // namespace spidar
