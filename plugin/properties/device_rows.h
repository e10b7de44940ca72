// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Properties that every element with a device has.
#pragma once

#include "plugin/device/device_warnings.h"
#include "plugin/properties/property_table.h"

namespace spidar {

/// `Settings` has the member profile.
template <typename Settings>
Property<Settings> profile_row() {
  return Property<Settings>::text({"profile", "Profile",
                                   "Geometry and motors: name of a shipped profile, or a .toml "
                                   "file. A real board gets no force without one"},
                                  kNull, KEPT_IN(profile));
}

/// `Settings` has the member on_device_error.
template <typename Settings>
Property<Settings> on_device_error_row() {
  return Property<Settings>::template choice<OnDeviceError>(
      {"on-device-error", "On device error",
       "What happens when the device cannot be opened, or fails while playing"},
      "GstSpidarOnDeviceError",
      {{OnDeviceError::kWarn, "Post a warning and go on without force, until the device returns",
        "warn"},
       {OnDeviceError::kError, "Post an error, which stops the pipeline", "error"}},
      kPlaying, KEPT_IN(on_device_error));
}

/// `Settings` has the member haptic_trace.
template <typename Settings>
Property<Settings> haptic_trace_row() {
  return Property<Settings>::text(
      {"haptic-trace", "Haptic trace",
       "File that gets a line of CSV for each millisecond, with forces, tensions and pose"},
      kNull, KEPT_IN(haptic_trace));
}

}  // namespace spidar
