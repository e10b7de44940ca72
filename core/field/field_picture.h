// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The reduced picture in which the motion of blocks is measured, and what its light does.
#pragma once

#include "core/picture/padded_image.h"

namespace spidar {

/// Pixels of the picture to one of the coarse picture, in which BlockField looks for what has
/// jumped.
constexpr int kCoarser = 4;

/// How much smaller this picture is than the base of the pyramid.
enum class FieldScale { kSame, kTwoThirds, kHalf };

/// 1, 2/3 or 1/2 of its sides, whichever brings its area nearest to 427 × 240 px without going
/// below kMinSide_px.
FieldScale field_scale(int base_width, int base_height);

/// Pixels of the base to one pixel of the picture: 1, 1.5 or 2.
double pixels_to_one(FieldScale scale);

/// Writes the reduced `base` to `picture`. With kTwoThirds each pixel is the rounded mean of the
/// area that it covers; columns and rows that do not fill a pixel are left out.
void reduce_to_field(const PaddedImage& base, FieldScale scale, PaddedImage& picture);

void reduce_to_two_thirds(const PaddedImage& image, PaddedImage& reduced);

/// When the brightness of the whole picture has changed (a flickering lamp, a fade, a shutter),
/// adapts the picture before to the new brightness, both `coarse_before`, in which it is seen in
/// comparison with `coarse_now`, and `before`. The change counts only if that makes the two
/// pictures more alike.
void compensate_light(PaddedImage& coarse_before, const PaddedImage& coarse_now,
                      PaddedImage& before);

}  // namespace spidar
