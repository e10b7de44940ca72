// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an application can set on the element.
#pragma once

#include <cstdint>
#include <string>

#include <gst/gst.h>

#include "core/analysis/motion_analyzer.h"
#include "plugin/properties/display_properties.h"
#include "plugin/properties/touch_properties.h"

namespace spidar {

enum class OnDeviceError { kWarn, kError };
enum class PointerKind { kFixed, kGrip };

struct MotionProperties {
  std::string device = "sim";
  std::string profile;        ///< empty: that of the device's board
  AnalyzerSettings analyzer;  ///< its pointer is the fixed one
  PointerKind pointer = PointerKind::kFixed;
  GstClockTimeDiff ts_offset_ns = 0;
  OnDeviceError on_device_error = OnDeviceError::kWarn;
  bool post_messages = true;
  std::string trace;
  std::string haptic_trace;
  std::string track;  ///< path, "auto", or empty
  bool mute = false;
  DisplayProperties display;
  TouchProperties touch;

  /// A name or a path for load_profile().
  std::string used_profile() const;
};

enum PropertyId : guint {
  kPropDevice = 1,
  kPropProfile,
  kPropController,
  kPropMotion,
  kPropPointer,
  kPropPointerX,
  kPropPointerY,
  kPropMaxForce,
  kPropAlpha,
  kPropDepthGain,
  kPropRollGain,
  kPropFilterMinCutoff,
  kPropFilterBeta,
  kPropQuality,
  kPropMaxFeatures,
  kPropQualityLevel,
  kPropMinDistance,
  kPropTsOffset,
  kPropOnDeviceError,
  kPropPostMessages,
  kPropTrace,
  kPropHapticTrace,
  kPropStats,
  kPropMute,
  kPropTrack,
};

/// Of the property `on-device-error`.
GType on_device_error_type();

/// Registers all of them, `stats` included.
void install_motion_properties(GObjectClass* object_class);

/// False for an id that is not a setting (`stats`, unknown).
bool set_motion_property(MotionProperties& properties, guint id, const GValue* value);
bool get_motion_property(const MotionProperties& properties, guint id, GValue* value);

}  // namespace spidar
