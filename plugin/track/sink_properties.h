// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an application can set on spidarsink. The words are those of spidarmotion.
#pragma once

#include <string>

#include <gst/gst.h>

#include "plugin/properties/motion_properties.h"

namespace spidar {

struct SinkProperties {
  std::string device = "sim";
  std::string profile;  ///< empty: that of the device's board
  double max_force_N = 3;
  double gain = 1;
  bool mute = false;
  OnDeviceError on_device_error = OnDeviceError::kWarn;
  std::string haptic_trace;

  /// A name or a path for load_profile().
  std::string used_profile() const;
};

enum SinkPropertyId : guint {
  kSinkDevice = 1,
  kSinkProfile,
  kSinkMaxForce,
  kSinkGain,
  kSinkMute,
  kSinkOnDeviceError,
  kSinkHapticTrace,
  kSinkStats,
};

/// Registers all of them, `stats` included; `ts-offset` is that of every sink.
void install_sink_properties(GObjectClass* object_class);

/// False for an id that is not a setting (`stats`, unknown).
bool set_sink_property(SinkProperties& properties, guint id, const GValue* value);
bool get_sink_property(const SinkProperties& properties, guint id, GValue* value);

}  // namespace spidar
