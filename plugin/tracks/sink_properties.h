// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What an application can set on spidarsink. The words are those of spidarmotion.
#pragma once

#include <string>

#include "plugin/output/device_warnings.h"

namespace spidar {

template <typename Settings>
class PropertyTable;

struct SinkProperties {
  std::string device = "sim";
  std::string profile;  ///< empty: that of the device's board
  double max_force_N = 3;
  double gain = 1;
  bool mute = false;
  OnDeviceError on_device_error = OnDeviceError::kWarn;
  std::string haptic_trace;
};

/// All of spidarsink, `stats` included; `ts-offset` is that of every sink.
const PropertyTable<SinkProperties>& sink_properties();

}  // namespace spidar
