// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <optional>
#include <string>

#include "spidar/device_error.h"

namespace spidar {

/// The identity of a device, as far as the system knows it. All texts are printable().
struct DeviceIdentity {
  std::string model;   ///< name, vendor and product: "Logitech G29 (046d:c24f)"
  std::string serial;  ///< empty if the device has none
  std::string place;   ///< where the device is connected: a port, or an address; empty if unknown

  /// Whether both are certainly the same device: the same model and serial number or, without one,
  /// the same place. Nothing distinguishes a device with neither from others.
  bool is_certainly(const DeviceIdentity& other) const {
    if (model != other.model || serial != other.serial) return false;
    return !serial.empty() || (!place.empty() && place == other.place);
  }

  std::string text() const {
    if (!serial.empty()) return model + ", serial number " + serial;
    return model + (place.empty() ? "" : " at " + place);
  }
};

/// The device that was opened first. Later, the system may give its number or port to another
/// device, perhaps with another strength and profile, and in another hand. That device gets no
/// force until the user starts again, which repeats all checks of the start.
class FirstDevice {
 public:
  bool known() const noexcept { return first_.has_value(); }
  bool is(const DeviceIdentity& found) const { return first_ && first_->is_certainly(found); }
  std::string text() const { return first_ ? first_->text() : ""; }

  /// Call this when a device has been opened: throws other() unless it is the first device.
  void require(const std::string& name, const DeviceIdentity& found) {
    if (!first_) {
      first_ = found;
    } else if (!is(found)) {
      throw other(name, found);
    }
  }

  /// The error for `found`, another device than the first one.
  DeviceError other(const std::string& name, const DeviceIdentity& found) const {
    const bool unknown = found.serial.empty() && found.place.empty();
    const std::string why = unknown ? " may be another device than the one that was lost"
                                    : " is another device than the one that was lost, " + text();
    return DeviceError(name + ": " + found.text() + why +
                           ": it gets no force. Plug that one in again, or stop and start to use "
                           "this one",
                       DeviceErrorCode::kSettings);
  }

 private:
  std::optional<DeviceIdentity> first_;
};

}  // namespace spidar
