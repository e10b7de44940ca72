// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Converts rows of a frame of any supported depth to 8 bits.
#pragma once

#include <cstdint>
#include <vector>

#include "core/picture/image_view.h"

namespace spidar {

/// Copies `columns` pixels of row `y` from column `x` on, all inside the frame.
void copy_row(const ImageView& frame, int x, int y, int columns, uint8_t* to);

/// Returns the frame itself if it has 8 bits, otherwise a converted copy in `buffer`.
ImageView in_8_bits(const ImageView& frame, std::vector<uint8_t>& buffer);

}  // namespace spidar
