// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Approximates a curve by few of its points.
#pragma once

#include <cstddef>
#include <vector>

namespace spidar {

/// Ascending indices of `values`, including the first and the last one, so that straight lines
/// between the values there pass all others within `tolerance`. Each line is as long as possible:
/// the slopes that pass all values so far form a cone, and the last value inside the cone ends the
/// line. Empty for no values.
std::vector<size_t> choose_keyframes(const std::vector<double>& values, double tolerance);

}  // namespace spidar
