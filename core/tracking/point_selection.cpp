// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/point_selection.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace spidar {
namespace {

constexpr int kNeighbourhood_px = 3;  // neighbourhood of eq. 1
constexpr int kSobel_px = 3;

/// Minimum RMS gradient in the weakest direction, grey levels per pixel. Weaker structure is noise
/// and rounding, whatever the rest of the picture contains.
constexpr double kMinWeakestGradient = 1.0;

/// cornerMinEigenVal() scales the Sobel sums by 1 / (4 · block · 255) before it adds block²
/// squares: a gradient of g grey levels per pixel in both directions gives (2 g / 255)².
constexpr double kMinResponse = (2 * kMinWeakestGradient / 255) * (2 * kMinWeakestGradient / 255);

struct Candidate {
  Feature feature;
  float response = 0;
  bool known = false;  ///< already followed: the id is valid
};

bool stronger(const Candidate& a, const Candidate& b) {
  if (a.response != b.response) return a.response > b.response;
  // Any fixed order makes the selection deterministic.
  if (a.feature.at.y_px != b.feature.at.y_px) return a.feature.at.y_px < b.feature.at.y_px;
  return a.feature.at.x_px < b.feature.at.x_px;
}

/// Pixels that are too close to a point already selected.
class Occupancy {
 public:
  Occupancy(cv::Size size, double min_distance_px)
      : taken_(cv::Mat::zeros(size, CV_8U)), radius_px_(min_distance_px) {}

  /// Returns false if another point is too close; otherwise marks the place as taken.
  bool take(const ImagePoint& at) {
    const int x = static_cast<int>(std::lround(at.x_px));
    const int y = static_cast<int>(std::lround(at.y_px));
    if (taken_.at<uint8_t>(y, x)) return false;
    const int reach = std::max(0, static_cast<int>(std::ceil(radius_px_)) - 1);
    for (int dy = -reach; dy <= reach; ++dy) {
      if (y + dy < 0 || y + dy >= taken_.rows) continue;
      // Marks the pixels strictly closer than the minimum distance.
      const double half_squared = radius_px_ * radius_px_ - dy * dy;
      int half = static_cast<int>(std::ceil(std::sqrt(std::max(0.0, half_squared)))) - 1;
      half = std::max(half, 0);
      const int from = std::max(0, x - half);
      const int to = std::min(taken_.cols - 1, x + half);
      std::fill(taken_.ptr(y + dy) + from, taken_.ptr(y + dy) + to + 1, uint8_t{1});
    }
    return true;
  }

 private:
  cv::Mat taken_;
  double radius_px_;
};

/// Whether no neighbour of pixel `x` is stronger; `above`, `row` and `below` are rows of the
/// response.
bool is_local_maximum(const float* above, const float* row, const float* below, int x) {
  const float value = row[x];
  // Most pixels fail within their own row.
  return row[x - 1] <= value && row[x + 1] <= value &&
         std::max({above[x - 1], above[x], above[x + 1]}) <= value &&
         std::max({below[x - 1], below[x], below[x + 1]}) <= value;
}

/// Local maxima of the response above the threshold, strongest first.
std::vector<Candidate> find_corners(const cv::Mat& response, double threshold, int border_px) {
  const auto least = static_cast<float>(threshold);
  std::vector<Candidate> corners;
  for (int y = border_px; y < response.rows - border_px; ++y) {
    const auto* row = response.ptr<float>(y);
    const auto* above = response.ptr<float>(y - 1);
    const auto* below = response.ptr<float>(y + 1);
    for (int x = border_px; x < response.cols - border_px; ++x) {
      if (row[x] <= least || !is_local_maximum(above, row, below, x)) continue;
      corners.push_back({{0, {static_cast<float>(x), static_cast<float>(y)}, {}}, row[x], false});
    }
  }
  std::sort(corners.begin(), corners.end(), stronger);
  return corners;
}

/// The followed points that are still above the threshold, strongest first.
std::vector<Candidate> rate(const std::vector<Feature>& features, const cv::Mat& response,
                            double threshold) {
  std::vector<Candidate> rated;
  for (const Feature& feature : features) {
    const int x = static_cast<int>(std::lround(feature.at.x_px));
    const int y = static_cast<int>(std::lround(feature.at.y_px));
    const float value = response.at<float>(y, x);
    if (static_cast<double>(value) > threshold) rated.push_back({feature, value, true});
  }
  std::sort(rated.begin(), rated.end(), stronger);
  return rated;
}

}  // namespace

void select_features(const cv::Mat& image, const SelectionSettings& settings, cv::Mat& response,
                     std::vector<Feature>& features, uint32_t& next_id) {
  cv::cornerMinEigenVal(image, response, kNeighbourhood_px, kSobel_px);
  double strongest = 0;
  cv::minMaxLoc(response, nullptr, &strongest);
  const double threshold = std::max(kMinResponse, settings.quality_level * strongest);

  // Closer to the border the eigenvalues include mirrored pixels.
  const int border_px = std::max(settings.border_px, kNeighbourhood_px / 2 + kSobel_px / 2);

  const auto limit = static_cast<size_t>(settings.max_features);
  // A distance beyond the picture's diagonal has no further effect; the bound keeps it within an
  // int.
  const double min_distance_px =
      std::min(settings.min_distance_px, std::hypot(image.cols, image.rows));
  Occupancy occupancy(image.size(), min_distance_px);
  std::vector<Candidate> selected;
  for (const Candidate& known : rate(features, response, threshold)) {
    if (occupancy.take(known.feature.at)) selected.push_back(known);
  }
  const size_t known_count = selected.size();
  for (const Candidate& corner : find_corners(response, threshold, border_px)) {
    if (selected.size() - known_count >= limit) break;
    if (occupancy.take(corner.feature.at)) selected.push_back(corner);
  }
  // Both parts are sorted.
  std::inplace_merge(selected.begin(), selected.begin() + static_cast<ptrdiff_t>(known_count),
                     selected.end(), stronger);
  if (selected.size() > limit) selected.resize(limit);

  features.clear();
  for (const Candidate& candidate : selected) {
    features.push_back(candidate.feature);
    if (!candidate.known) features.back().id = next_id++;
  }
}

}  // namespace spidar
