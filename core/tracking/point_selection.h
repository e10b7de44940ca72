// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which points of a picture are worth following (Shi–Tomasi, eq. 1).
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
  ImagePoint at;     ///< pixels of the picture it was selected in
  ImagePoint moved;  ///< displacement since the picture before; 0 for a new one
};

struct SelectionSettings {
  int max_features = 0;
  double quality_level = 0;
  double min_distance_px = 0;  ///< in pixels of the picture given
  int border_px = 0;           ///< no point is nearer to the border
};

/// Brings `features` to what eq. 1 selects in `image` (8-bit, one channel): points whose smaller
/// eigenvalue is above `quality_level` times the picture's largest one, the strongest first, none
/// nearer to another than `min_distance_px`, at most `max_features`.
///
/// A point that is followed already keeps its place and id as long as it is strong enough, and goes
/// before a new one near it; new ones get ids from `next_id` on. When there are too many, the
/// weakest go, old or new: an object that enters gets its share of the points.
/// The order is strongest first.
///
/// `response` is a buffer for the eigenvalues. Give the same each time: large blocks that are freed
/// after each use go back to the system, and fetching their pages again costs more than the search.
void select_features(const cv::Mat& image, const SelectionSettings& settings, cv::Mat& response,
                     std::vector<Feature>& features, uint32_t& next_id);

}  // namespace spidar
