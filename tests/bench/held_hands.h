// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

namespace spidar::bench {

/// Prints how much of the force hands lose to the brake: see held_hands.cpp.
void held_hands();

}  // namespace spidar::bench
