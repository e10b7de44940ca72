// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Few points of a curve that say nearly all of it.
#pragma once

#include <cstddef>
#include <vector>

#include "core/api.h"

namespace spidar {

/// Indices of `values`, rising, the first and the last among them, so that the straight lines
/// between the values there pass all others within `tolerance`. Each line is as long as it can be
/// from where it begins: the slopes that pass all values so far are a cone, and the last value that
/// lies in it ends the line. Empty for no values.
SPIDAR_API std::vector<size_t> choose_keyframes(const std::vector<double>& values,
                                                double tolerance);

}  // namespace spidar
