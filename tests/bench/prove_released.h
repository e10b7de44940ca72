// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

namespace spidar::bench {

/// Prints how fast a free grip gets along one axis, for every film: see prove_released.cpp.
void prove_released();

}  // namespace spidar::bench
