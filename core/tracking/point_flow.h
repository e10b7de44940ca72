// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds points of one picture in the next (pyramidal Lucas–Kanade, eq. 2–8).
#pragma once

#include <vector>

#include "core/tracking/tracker.h"

namespace cv {
class Mat;
}

namespace spidar {

/// The pyramid levels of a picture and their derivatives. Built once per frame and used first as
/// the target, then as the source of the search.
using FlowPyramid = std::vector<cv::Mat>;

/// `image`: 8-bit, one channel. Reuses the memory of `pyramid` when the size is the same.
void build_pyramid(const cv::Mat& image, FlowPyramid& pyramid);

/// Margin in pixels at the border of `image` in which points are not followed: their windows would
/// contain mirrored pixels, which move in the opposite direction.
int follow_border_px(const cv::Mat& image);

/// A point of one picture that is searched in the next; lengths in pixels of the pictures.
struct PointFlow {
  ImagePoint from;
  ImagePoint expected;  ///< displacement to try first, for example the last one
  ImagePoint to;        ///< new position, if found
  bool found = false;
};

/// Searches `points` of `before` in `now`; both pictures have the same size. A point counts as
/// found if its new position is inside the border, the surroundings match, and the backward search
/// returns to its origin.
void follow_points(const FlowPyramid& before, const FlowPyramid& now,
                   std::vector<PointFlow>& points);

}  // namespace spidar
