// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

namespace spidar {

/// The default limits of every device: what a hand holds against without effort.
constexpr double kDefaultForce_N = 3;
constexpr double kDefaultTorque_Nm = 0.1;

}  // namespace spidar
