// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Devices that take a force, driven without a loop.
#pragma once

#include "spidar/grip/grip.h"
#include "spidar/link/board.h"

namespace spidar::test {

/// Forces are switched on; to the right and up.
inline GripCommand told(double right_N, double up_N = 0) {
  GripCommand command;
  command.wrench.force_N = {right_N, up_N, 0};
  command.power = 1;
  return command;
}

/// The same below the grip.
inline boards::ForceOutput pushing(double right_N, double up_N = 0) {
  return {{right_N, up_N, 0}, true};
}

}  // namespace spidar::test
