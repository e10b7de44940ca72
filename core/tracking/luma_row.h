// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Rows of a frame in 8 bits, whatever it is stored in.
#pragma once

#include <cstdint>
#include <vector>

#include "core/api.h"
#include "core/image_view.h"

namespace spidar {

/// `columns` pixels of row `y` from column `x` on, all of them inside the frame.
SPIDAR_API void copy_row(const ImageView& frame, int x, int y, int columns, uint8_t* to);

/// The whole frame in `buffer`, or the frame itself when it has 8 bits.
ImageView in_8_bits(const ImageView& frame, std::vector<uint8_t>& buffer);

/// The same, pixel by pixel as defined: what the fast version is compared with.
namespace plain {
void copy_row(const ImageView& frame, int x, int y, int columns, uint8_t* to);
}  // namespace plain

}  // namespace spidar
