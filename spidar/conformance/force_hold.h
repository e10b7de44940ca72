// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Sets the force of a grip directly, millisecond by millisecond.
#pragma once

#include <functional>

#include <Eigen/Core>

#include "spidar/conformance/string_hold.h"
#include "spidar/grip/grip.h"

namespace spidar {

/// Keeps a grip open during its lifetime. What StringHold is for strings. Every function throws
/// DeviceError when the device is lost.
class ForceHold {
 public:
  /// Opens the grip with forces switched off. Throws DeviceError.
  ForceHold(Grip& grip, Pace pace);
  /// Closes the grip.
  ~ForceHold();
  ForceHold(const ForceHold&) = delete;
  ForceHold& operator=(const ForceHold&) = delete;

  /// Switches forces on, and goes to this one at a constant rate within the given time. Returns
  /// false when ended early.
  bool go(const Eigen::Vector3d& force_N, double seconds);

  /// Holds the force for the given time. Calls `seen` with every reading and ends when it returns
  /// false. Returns false when the pace ended it early.
  bool stay(double seconds, const std::function<bool(const GripReading&)>& seen = {});

 private:
  bool exchange();

  Grip& grip_;
  const Pace pace_;
  GripCommand command_;
  int errors_in_a_row_ = 0;
};

}  // namespace spidar
