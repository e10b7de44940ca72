// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A small picture to look for motion in.
#pragma once

#include "core/image_view.h"
#include "core/tracking/pixel_scale.h"
#include "core/tracking/tracker.h"

namespace cv {
class Mat;
}

namespace spidar {

/// Whole number of frame pixels to one pixel of the reduced picture, so that its longer side is
/// about 480 px: motion is found as well as at full size in a fraction of the time. At least 1, and
/// small enough to leave kMinSide_px of the shorter side.
int reduction_factor(int width, int height);

/// Mean of each factor × factor block of a frame of 8 bits. Columns and rows at the right and
/// bottom that do not fill a block are left out, so that the scale is exactly `factor`. With factor
/// 1 `reduced` refers to the memory of `frame`.
void reduce_luma(const ImageView& frame, int factor, cv::Mat& reduced);

}  // namespace spidar
