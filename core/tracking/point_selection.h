// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Selects points to follow (Shi–Tomasi, eq. 1).
#pragma once

#include <cstdint>
#include <vector>

#include "core/tracking/tracker.h"

namespace cv {
class Mat;
}

namespace spidar {

/// A point that is followed.
struct Feature {
  uint32_t id = 0;
  ImagePoint at;     ///< in pixels of the picture it was selected in
  ImagePoint moved;  ///< displacement since the previous picture; 0 for a new point
};

struct SelectionSettings {
  int max_features = 0;
  double quality_level = 0;
  double min_distance_px = 0;  ///< in pixels of the picture given
  int border_px = 0;           ///< minimum distance of points from the border
};

/// Updates `features` by selection with eq. 1 in `image` (8-bit, one channel): at most
/// `max_features` points whose smaller eigenvalue is above `quality_level` times the largest one of
/// the picture, at least `min_distance_px` apart.
///
/// A followed point keeps its position and id as long as it is strong enough, and has priority over
/// new points near it. New points get ids from `next_id` on. If there are too many points, the
/// weakest are dropped, old or new, so that an object that enters gets its share. The order is
/// strongest first.
///
/// `response` is a buffer for the eigenvalues. Pass the same one each time: a large block that is
/// freed after each use returns to the system, and faulting its pages in again costs more than the
/// search.
void select_features(const cv::Mat& image, const SelectionSettings& settings, cv::Mat& response,
                     std::vector<Feature>& features, uint32_t& next_id);

}  // namespace spidar
