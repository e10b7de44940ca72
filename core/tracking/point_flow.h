// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Where points of one picture are in the next (pyramidal Lucas–Kanade, eq. 2–8).
#pragma once

#include <vector>

#include "core/tracking/tracker.h"

namespace cv {
class Mat;
}

namespace spidar {

/// What Lucas–Kanade needs of one picture: its levels and their derivatives. Built once a frame,
/// used as the picture that points go to, then as the one they come from.
using FlowPyramid = std::vector<cv::Mat>;

/// `image`: 8-bit, one channel. Reuses the memory of `pyramid` when the size is the same.
void build_pyramid(const cv::Mat& image, FlowPyramid& pyramid);

/// Points nearer to the border of `image` than this are not followed, pixels: their window would
/// reach over it, to mirrored pixels that move the other way.
int follow_border_px(const cv::Mat& image);

/// A point of one picture that is looked for in the next; lengths in pixels of the pictures.
struct PointFlow {
  ImagePoint from;
  ImagePoint expected;  ///< displacement to try first, the last one for example
  ImagePoint to;        ///< where it is, if found
  bool found = false;
};

/// Looks for `points` of `before` in `now`, pictures of one size. A point is found if its place is
/// inside the border, shows the same surroundings, and leads back to where it came from.
void follow_points(const FlowPyramid& before, const FlowPyramid& now,
                   std::vector<PointFlow>& points);

}  // namespace spidar
