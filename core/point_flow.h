/// Where points of one picture are in the next (pyramidal Lucas–Kanade, eq. 2–8).
#pragma once

#include <vector>

#include "core/tracker.h"

namespace cv {
class Mat;
}

namespace spidar {

/// What Lucas–Kanade needs of one picture: its levels and their derivatives. Built once a frame,
/// used as the picture that points go to, then as the one they come from.
using FlowPyramid = std::vector<cv::Mat>;

/// `image`: 8-bit, one channel. Reuses the memory of `pyramid` when the size is the same.
void build_pyramid(const cv::Mat& image, FlowPyramid& pyramid);

/// Looks for points of `before` in `now`, pictures of one size. `found[i]` says whether `to[i]` is
/// the place of `from[i]`: inside the picture, the same place when followed back again, and with
/// surroundings that look alike. The results have the size of `from`.
void follow_points(const FlowPyramid& before, const FlowPyramid& now,
                   const std::vector<ImagePoint>& from, std::vector<ImagePoint>& to,
                   std::vector<bool>& found);

}  // namespace spidar
