// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Strings that are pulled one millisecond after the other, without a wrench.
#pragma once

#include <functional>

#include "core/api.h"
#include "core/grip/string_geometry.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Waits for the next millisecond; false: end early.
using Pace = std::function<bool()>;

/// A device that is open for as long as this lives. Tensions change along straight lines. Every
/// function throws DeviceError when the device is lost.
class SPIDAR_API StringHold {
 public:
  /// Opens the device, whose tensions are zero then. Throws DeviceError.
  StringHold(Device& device, const Profile& profile, Pace pace);
  /// Closes it, which takes what is left of the tensions to zero.
  ~StringHold();
  StringHold(const StringHold&) = delete;
  StringHold& operator=(const StringHold&) = delete;

  /// To these tensions within that time. Newtons, within zero and each string's largest. False when
  /// ended early.
  bool go(const StringVector& tension_N, double seconds);

  /// As they are for so long, which may be for ever. `seen` gets every reading; when it returns
  /// false, that is all. False when ended early by the pace.
  bool stay(double seconds, const std::function<bool(const DeviceReading&)>& seen = {});

  /// To zero, whatever the pace says.
  void release();

  /// This string's volts have the other sign from now on. Its tension must be zero.
  void reverse_motor(int string);

  const StringVector& tension_N() const noexcept { return tension_N_; }

 private:
  bool exchange();

  Device& device_;
  Profile profile_;
  const Pace pace_;
  StringVector tension_N_ = StringVector::Zero();
  DeviceReading reading_;
  int errors_in_a_row_ = 0;
};

}  // namespace spidar
