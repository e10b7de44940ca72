// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Brings what is measured of a block to the range that a network likes.
#pragma once

#include <cstddef>

namespace spidar {

/// Replaces kFeatures numbers of each of `blocks` blocks by theirs in scale.
void scale_features(float* values, size_t blocks);

}  // namespace spidar
