// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The properties that an application can set on the element.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <gst/gst.h>

#include "core/analysis/force_renderer.h"
#include "core/touch/depth_picture.h"
#include "plugin/device/device_warnings.h"

namespace spidar {

struct TouchProperties {
  /// The source of the relief.
  enum class Kind { kOff, kLuma, kDepth, kDepthBelow };

  Kind kind = Kind::kOff;
  double relief_mm = 8;  ///< from black to white, or from far to near
  double stiffness_N_m = 500;
  double friction = 0.3;       ///< μs; μd is 0.8 of it
  double texture = 0;          ///< gain for the slope of fine detail
  double motion_fraction = 0;  ///< how much of the film's motion is also rendered

  /// The part of the film's frames that has the depth; nothing where the whole frame is picture.
  std::optional<touch::DepthLayout> packed() const {
    if (kind == Kind::kDepth) return touch::DepthLayout::kRight;
    if (kind == Kind::kDepthBelow) return touch::DepthLayout::kBelow;
    return std::nullopt;
  }
};

struct DisplayProperties {
  enum class Overlay {
    kNone,
    kForce,   ///< outlines of objects, the force, finger and contact
    kPoints,  ///< also arrows of the motion
    kCurve,   ///< kForce, and the force of the last seconds
  };

  Overlay overlay = Overlay::kNone;
  double arrow_scale = 4;
  bool debug_window = false;
  bool attach_meta = false;
};

template <typename Settings>
class PropertyTable;

struct Pointer {
  enum class Kind { kFixed, kGrip, kMouse };

  Kind kind = Kind::kFixed;
  /// The position with kFixed; otherwise the position until the device runs or the mouse moves. (0,
  /// 0) is the top left corner of the picture, (1, 1) its bottom right one.
  Eigen::Vector2d position{0.5, 0.5};
};

/// The settings that are read again for each frame.
struct FrameSettings {
  /// In the settings of the element, the pointer is the fixed one. In the settings of a frame, the
  /// pointer is a position in the frame before it is turned, and rules, boxes and click are set.
  AnalyzerSettings analyzer;
  Pointer::Kind pointer = Pointer::Kind::kFixed;
  OnDeviceError on_device_error = OnDeviceError::kWarn;
  bool post_messages = true;
  DisplayProperties display;
  TouchProperties touch;
};

struct MotionProperties : FrameSettings {
  std::string device = "sim";
  std::string profile;        ///< empty: that of the device's board
  bool alpha_is_set = false;  ///< otherwise alpha follows `motion`
  GstClockTimeDiff ts_offset_ns = 0;
  std::string trace;
  std::string haptic_trace;
  std::string track;  ///< path, "auto", or empty
  std::string feel;   ///< path, "auto", rules, or empty
  bool mute = false;
};

/// All properties of spidarmotion, `stats` included.
const PropertyTable<MotionProperties>& motion_properties();

/// Parses "grip", "mouse", or "X,Y" with numbers from 0 to 1; nothing for other texts.
std::optional<Pointer> parse_pointer(const std::string& text);
std::string text_of(const Pointer& pointer);

/// Parses "whole", "auto", or four whole numbers with commas between them: x, y, width and height
/// in pixels, from 0 and kMinSide_px to kMaxSide_px; nothing for other texts.
std::optional<AreaSetting> parse_area(const std::string& text);
std::string text_of(const AreaSetting& area);
/// The largest number of an area; no video format has a larger frame.
constexpr int kMaxSide_px = 1 << 16;

}  // namespace spidar
