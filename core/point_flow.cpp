#include "core/point_flow.h"

#include <algorithm>
#include <cmath>

#include <opencv2/video/tracking.hpp>

namespace spidar {
namespace {

constexpr int kWindow_px = 15;
constexpr int kMaxLevel = 3;  // displacements up to about kWindow / 2 · 2³ px
const cv::TermCriteria kStop(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.01);

/// OpenCV's smallest eigenvalue is the mean squared gradient (grey levels per pixel) / 1024.
constexpr double kMinGradient = 1.0;
constexpr double kMinEigenvalue = kMinGradient * kMinGradient / 1024;

/// Distance between a point and where it comes back to, px.
constexpr float kMaxReturn_px = 0.5f;

/// A window that differs from its origin by more than this share of its own contrast shows
/// something else. The contrast is the measure because a fixed limit would refuse textured points
/// in a noisy film and accept any place of a flat one.
constexpr float kMaxDifference = 0.5f;
/// Grey levels that rounding and resampling leave where nothing changed.
constexpr float kRounding = 1.0f;

/// Mean absolute deviation of the window around `at` from its mean, grey levels.
float contrast(const cv::Mat& image, const ImagePoint& at) {
  constexpr int kHalf = kWindow_px / 2;
  const cv::Rect window(static_cast<int>(std::lround(at.x_px)) - kHalf,
                        static_cast<int>(std::lround(at.y_px)) - kHalf, kWindow_px, kWindow_px);
  const cv::Mat patch = image(window & cv::Rect({0, 0}, image.size()));
  int sum = 0;
  for (int y = 0; y < patch.rows; ++y) {
    const uint8_t* row = patch.ptr(y);
    for (int x = 0; x < patch.cols; ++x) sum += row[x];
  }
  const int count = patch.rows * patch.cols;
  const int mean = (sum + count / 2) / count;
  int deviation = 0;
  for (int y = 0; y < patch.rows; ++y) {
    const uint8_t* row = patch.ptr(y);
    for (int x = 0; x < patch.cols; ++x) deviation += std::abs(row[x] - mean);
  }
  return static_cast<float>(deviation) / static_cast<float>(count);
}

bool inside(const cv::Mat& image, const cv::Point2f& p) {
  return p.x >= 0 && p.y >= 0 && p.x <= static_cast<float>(image.cols - 1) &&
         p.y <= static_cast<float>(image.rows - 1);
}

struct Flow {
  std::vector<cv::Point2f> to;
  std::vector<uint8_t> found;
  std::vector<float> difference;  ///< mean absolute difference of the windows, grey levels
};

Flow lucas_kanade(const FlowPyramid& before, const FlowPyramid& now,
                  const std::vector<cv::Point2f>& from) {
  Flow flow;
  cv::calcOpticalFlowPyrLK(before, now, from, flow.to, flow.found, flow.difference,
                           cv::Size(kWindow_px, kWindow_px), kMaxLevel, kStop, 0, kMinEigenvalue);
  return flow;
}

}  // namespace

void build_pyramid(const cv::Mat& image, FlowPyramid& pyramid) {
  constexpr bool kWithDerivatives = true;  // used twice: forwards from this picture, and back
  constexpr bool kReuseInput = false;      // the input lives shorter than the pyramid
  cv::buildOpticalFlowPyramid(image, pyramid, cv::Size(kWindow_px, kWindow_px), kMaxLevel,
                              kWithDerivatives, cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT,
                              kReuseInput);
}

void follow_points(const FlowPyramid& before, const FlowPyramid& now,
                   const std::vector<ImagePoint>& from, std::vector<ImagePoint>& to,
                   std::vector<bool>& found) {
  to.assign(from.size(), {});
  found.assign(from.size(), false);
  if (from.empty()) return;

  std::vector<cv::Point2f> origins;
  origins.reserve(from.size());
  for (const ImagePoint& p : from) origins.emplace_back(p.x_px, p.y_px);
  const cv::Mat& image = before[0];
  const Flow forward = lucas_kanade(before, now, origins);

  std::vector<size_t> index;
  std::vector<cv::Point2f> arrived;
  for (size_t i = 0; i < from.size(); ++i) {
    if (!forward.found[i] || !inside(image, forward.to[i])) continue;
    const float limit = std::max(kRounding, kMaxDifference * contrast(image, from[i]));
    if (forward.difference[i] > limit) continue;
    index.push_back(i);
    arrived.push_back(forward.to[i]);
  }
  if (arrived.empty()) return;

  const Flow back = lucas_kanade(now, before, arrived);
  for (size_t k = 0; k < index.size(); ++k) {
    const size_t i = index[k];
    const cv::Point2f miss = back.to[k] - origins[i];
    if (!back.found[k] || std::hypot(miss.x, miss.y) > kMaxReturn_px) continue;
    to[i] = {arrived[k].x, arrived[k].y};
    found[i] = true;
  }
}

}  // namespace spidar
