// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/point_flow.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <opencv2/video/tracking.hpp>

namespace spidar {
namespace {

constexpr int kWindow_px = 15;
constexpr int kMaxLevel = 3;  // a level reaches about half a window: 7 px · 2³ in all

/// OpenCV's smallest eigenvalue is the mean squared gradient (grey levels per pixel) / 1024.
constexpr double kMinMeanGradient = 1.0;
constexpr double kMinEigenvalue = kMinMeanGradient * kMinMeanGradient / 1024;

/// Largest forward–backward error, px. Correct matches return to within a few hundredths of a
/// pixel, wrong ones to anywhere.
constexpr float kMaxReturn_px = 0.2f;

/// Mean absolute difference of the windows due to rounding and resampling, grey levels.
constexpr float kRounding = 1.0f;

/// Settings of one search for points.
struct Search {
  int level;      ///< coarsest pyramid level
  bool expected;  ///< start at the expected displacement, not at the old place
  /// Largest difference of the windows, as a share of the contrast in them. The limit is relative
  /// because a fixed one would reject textured points in a noisy film and accept any position in a
  /// flat one.
  float max_difference;
};

/// Few points change their motion much: the two finest levels find them. This also keeps a periodic
/// texture from jumping by a period, to which the coarse levels are prone. Only a clear match
/// counts.
constexpr Search kNear{1, true, 0.15f};
/// For the other points all levels are searched.
constexpr Search kFar{kMaxLevel, false, 0.5f};

/// Mean absolute deviation of the window around `at` from its mean, grey levels.
float contrast(const cv::Mat& image, const cv::Point2f& at) {
  constexpr int kHalf = kWindow_px / 2;
  const cv::Rect window(static_cast<int>(std::lround(at.x)) - kHalf,
                        static_cast<int>(std::lround(at.y)) - kHalf, kWindow_px, kWindow_px);
  const cv::Mat patch = image(window & cv::Rect({0, 0}, image.size()));
  const int count = patch.rows * patch.cols;
  int sum = 0;
  for (int y = 0; y < patch.rows; ++y) {
    for (int x = 0; x < patch.cols; ++x) sum += patch.ptr(y)[x];
  }
  const int mean = (sum + count / 2) / count;
  int deviation = 0;
  for (int y = 0; y < patch.rows; ++y) {
    for (int x = 0; x < patch.cols; ++x) deviation += std::abs(patch.ptr(y)[x] - mean);
  }
  return static_cast<float>(deviation) / static_cast<float>(count);
}

bool inside(const cv::Mat& image, const cv::Point2f& p) {
  const auto border = static_cast<float>(follow_border_px(image));
  return p.x >= border && p.y >= border && p.x <= static_cast<float>(image.cols - 1) - border &&
         p.y <= static_cast<float>(image.rows - 1) - border;
}

struct Flow {
  std::vector<cv::Point2f> to;
  std::vector<uint8_t> found;
  std::vector<float> difference;  ///< mean absolute difference of the windows, grey levels
};

Flow lucas_kanade(const FlowPyramid& before, const FlowPyramid& now,
                  const std::vector<cv::Point2f>& from, std::vector<cv::Point2f> guess, int level) {
  static const cv::TermCriteria kStop(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.01);
  Flow flow;
  flow.to = std::move(guess);
  cv::calcOpticalFlowPyrLK(before, now, from, flow.to, flow.found, flow.difference,
                           cv::Size(kWindow_px, kWindow_px), level, kStop,
                           cv::OPTFLOW_USE_INITIAL_FLOW, kMinEigenvalue);
  return flow;
}

/// Points during a search: index into the caller's points, old place, new place, and the
/// displacement with which the search started.
struct Candidates {
  std::vector<size_t> index;
  std::vector<cv::Point2f> from;
  std::vector<cv::Point2f> start;
  std::vector<cv::Point2f> to;

  std::vector<cv::Point2f> guesses(const std::vector<cv::Point2f>& places, float sign) const {
    std::vector<cv::Point2f> guess;
    for (size_t i = 0; i < places.size(); ++i) guess.push_back(places[i] + sign * start[i]);
    return guess;
  }
};

/// The points that have not been found yet.
Candidates missing(const std::vector<PointFlow>& points, const Search& search) {
  Candidates c;
  for (size_t i = 0; i < points.size(); ++i) {
    const PointFlow& p = points[i];
    if (p.found) continue;
    c.index.push_back(i);
    c.from.emplace_back(p.from.x_px, p.from.y_px);
    c.start.emplace_back(search.expected ? cv::Point2f(p.expected.x_px, p.expected.y_px)
                                         : cv::Point2f());
  }
  return c;
}

/// The points whose new place in the picture looks like the old one.
Candidates forward(const FlowPyramid& before, const FlowPyramid& now, const Candidates& c,
                   const Search& search) {
  const cv::Mat& image = before[0];
  const Flow flow = lucas_kanade(before, now, c.from, c.guesses(c.from, 1), search.level);
  Candidates alike;
  for (size_t i = 0; i < c.index.size(); ++i) {
    if (!flow.found[i] || !inside(image, flow.to[i])) continue;
    const float limit = std::max(kRounding, search.max_difference * contrast(image, c.from[i]));
    if (flow.difference[i] > limit) continue;
    alike.index.push_back(c.index[i]);
    alike.from.push_back(c.from[i]);
    alike.start.push_back(c.start[i]);
    alike.to.push_back(flow.to[i]);
  }
  return alike;
}

/// Tries to find the missing points: forwards, and back in the same way.
void follow_missing(const FlowPyramid& before, const FlowPyramid& now, const Search& search,
                    std::vector<PointFlow>& points) {
  const Candidates tried = missing(points, search);
  if (tried.index.empty()) return;
  const Candidates alike = forward(before, now, tried, search);
  if (alike.index.empty()) return;
  const Flow back = lucas_kanade(now, before, alike.to, alike.guesses(alike.to, -1), search.level);
  for (size_t i = 0; i < alike.index.size(); ++i) {
    const cv::Point2f miss = back.to[i] - alike.from[i];
    if (!back.found[i] || std::hypot(miss.x, miss.y) > kMaxReturn_px) continue;
    PointFlow& point = points[alike.index[i]];
    point.to = {alike.to[i].x, alike.to[i].y};
    point.found = true;
  }
}

}  // namespace

int follow_border_px(const cv::Mat& image) {
  // The limit of a quarter keeps half of a tiny picture usable.
  return std::min({kWindow_px / 2, image.cols / 4, image.rows / 4});
}

void build_pyramid(const cv::Mat& image, FlowPyramid& pyramid) {
  constexpr bool kWithDerivatives = true;  // used twice: forwards from this picture, and back
  constexpr bool kReuseInput = false;      // the input lives shorter than the pyramid
  cv::buildOpticalFlowPyramid(image, pyramid, cv::Size(kWindow_px, kWindow_px), kMaxLevel,
                              kWithDerivatives, cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT,
                              kReuseInput);
}

void follow_points(const FlowPyramid& before, const FlowPyramid& now,
                   std::vector<PointFlow>& points) {
  follow_missing(before, now, kNear, points);
  follow_missing(before, now, kFar, points);
}

}  // namespace spidar
