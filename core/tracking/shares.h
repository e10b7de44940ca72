// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Shares of a whole that count as most of it, and as nearly all of it.
#pragma once

namespace spidar {

constexpr double kMost = 0.5;
constexpr double kNearlyAll = 0.8;

}  // namespace spidar
