// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Luma in 8 bits, of frames of any supported depth and of packed RGB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/picture/image_view.h"

namespace spidar {

/// Copies `columns` pixels of row `y` from column `x` on, all inside the frame.
void copy_row(const ImageView& frame, int x, int y, int columns, uint8_t* to);

/// Returns the frame itself if it has 8 bits, otherwise a converted copy in `buffer`.
ImageView in_8_bits(const ImageView& frame, std::vector<uint8_t>& buffer);

/// Order of the bytes of a pixel; x is padding or alpha and is ignored.
enum class PackedOrder { kRgb, kBgr, kRgbx, kBgrx };

/// Luma 0.299 R + 0.587 G + 0.114 B (BT.601) of `height` rows of `width` pixels. Written to
/// `buffer`, which is resized and must live as long as the view.
ImageView luma_of_packed(const uint8_t* data, int width, int height, ptrdiff_t stride_bytes,
                         PackedOrder order, std::vector<uint8_t>& buffer);

}  // namespace spidar
