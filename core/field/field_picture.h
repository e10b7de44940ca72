// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The small picture that a field of block motion is found in.
#pragma once

#include "core/tracking/gray_pyramid.h"

namespace spidar {

/// How much smaller that picture is than the base of the pyramid: as 1, 2/3 or 1/2 of its sides,
/// whichever brings its area nearest to 427 × 240 px without going below kMinSide_px.
enum class FieldScale { kSame, kTwoThirds, kHalf };
FieldScale field_scale(int base_width, int base_height);

/// Pixels of the base to one of the picture: 1, 1.5 or 2.
double pixels_to_one(FieldScale scale);

/// `picture` becomes `base`, smaller. kTwoThirds takes the mean of the area that each pixel covers,
/// rounded; columns and rows that do not fill a pixel are left out.
void reduce_to_field(const PaddedImage& base, FieldScale scale, PaddedImage& picture);

namespace vectors {
void reduce_to_two_thirds(const PaddedImage& image, PaddedImage& reduced);
}
namespace plain {
void reduce_to_two_thirds(const PaddedImage& image, PaddedImage& reduced);
}

}  // namespace spidar
