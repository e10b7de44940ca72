// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The period of the haptic loop.
#pragma once

#include <cstdint>

namespace spidar {

constexpr int64_t kTick_ns = 1'000'000;  ///< 1 kHz
constexpr double kTick_s = 1e-9 * kTick_ns;

}  // namespace spidar
