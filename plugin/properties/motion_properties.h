// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an application can set on the element.
#pragma once

#include <cstdint>
#include <string>

#include <gst/gst.h>

#include "core/analysis/motion_analyzer.h"
#include "plugin/properties/display_properties.h"
#include "plugin/properties/on_device_error.h"
#include "plugin/properties/touch_properties.h"

namespace spidar {

template <typename Settings>
class PropertyTable;

enum class PointerKind { kFixed, kGrip, kMouse };

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
  std::string feel;   ///< the same, or rules
  bool mute = false;
  DisplayProperties display;
  TouchProperties touch;
};

/// All of spidarmotion, `stats` included.
const PropertyTable<MotionProperties>& motion_properties();

}  // namespace spidar
