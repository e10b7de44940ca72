// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reduces a picture for motion estimation.
#pragma once

#include "core/image_view.h"
#include "core/tracking/pixel_scale.h"
#include "core/tracking/tracker.h"

namespace cv {
class Mat;
}

namespace spidar {

/// Integer reduction factor that makes the longer side about 480 px, where motion is found as well
/// as at full size in a fraction of the time. It is at least 1, and small enough that the shorter
/// side keeps kMinSide_px.
int reduction_factor(int width, int height);

/// Computes the mean of each factor × factor block of an 8-bit frame. Incomplete blocks at the
/// right and bottom are left out, so that the scale is exactly `factor`. With factor 1, `reduced`
/// refers to the memory of `frame`.
void reduce_luma(const ImageView& frame, int factor, cv::Mat& reduced);

}  // namespace spidar
