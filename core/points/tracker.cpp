// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/points/tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "core/picture/opencv.h"
#include "core/picture/reduced_frame.h"
#include "core/require.h"

namespace spidar {
namespace {

/// The maximum number of points, as in the usual examples of Lucas–Kanade.
constexpr int kMaxFeatures = 200;
/// New points are selected when fewer than this fraction of the last selection is left …
constexpr double kThinnedOut = 0.7;
/// … and after this many frames in any case, because something may have entered.
constexpr int kSelectionInterval = 5;

/// A cut is detected when at least kMinForCut points were searched and less than this fraction was
/// found. With fewer points, the loss of a small object is more likely.
constexpr double kFoundAfterCut = 0.1;
constexpr size_t kMinForCut = 10;

constexpr int kNeighbourhood_px = 3;  // of eq. 1
constexpr int kSobel_px = 3;
/// The minimum RMS gradient in the weakest direction, grey levels per pixel. Weaker structure is
/// noise and rounding, whatever the rest of the picture contains.
constexpr double kMinWeakestGradient = 1.0;
/// OpenCV scales the Sobel sums by 1 / (4 · block · 255) before it adds block² squares: a gradient
/// of g grey levels per pixel in both directions gives (2 g / 255)².
constexpr double kMinResponse = (2 * kMinWeakestGradient / 255) * (2 * kMinWeakestGradient / 255);
/// OpenCV refuses a level of 0; with this one kMinResponse is higher in any picture.
constexpr double kMinQualityLevel = 1e-6;

constexpr int kWindow_px = 15;
constexpr int kMaxPyramidLevel = 3;  // a level reaches about half a window: 7 px · 2³ in all
/// OpenCV's smallest eigenvalue is the mean squared gradient (grey levels per pixel) / 1024.
constexpr double kMinEigenvalue = kMinWeakestGradient * kMinWeakestGradient / 1024;
/// The largest forward–backward error, px. Correct matches return to within a few hundredths of a
/// pixel, wrong ones to anywhere.
constexpr double kMaxReturn_px = 0.2;
/// The mean absolute difference of the windows due to rounding and resampling, grey levels.
constexpr double kRounding = 1.0;

struct PointSearch {
  int level;      ///< the coarsest pyramid level
  bool expected;  ///< starts at the last displacement, not at the old position
  /// The largest difference of the windows, as a fraction of the contrast in them. The limit is
  /// relative because a fixed one would reject textured points in a noisy film and accept any
  /// position in a flat one.
  double max_difference;
};

/// Few points change their motion much: the two finest levels find them. This also keeps a periodic
/// texture from jumping by a period, as the coarse levels do. Only a clear match counts. For the
/// other points all levels are searched.
constexpr PointSearch kSearches[] = {{1, true, 0.12}, {kMaxPyramidLevel, false, 0.4}};

/// A point that is followed, in the reduced picture.
struct Feature {
  uint32_t id = 0;
  cv::Point2f at;
  cv::Point2f moved;  ///< displacement since the previous picture; 0 for a new point
};

/// The margin at the border in which points are not followed: their windows would contain mirrored
/// pixels, which move in the opposite direction. A quarter keeps half of a tiny picture usable.
int border_px(const cv::Mat& image) {
  return std::min({kWindow_px / 2, image.cols / 4, image.rows / 4});
}

bool is_inside(const cv::Mat& image, const cv::Point2f& p) {
  const auto border = static_cast<float>(border_px(image));
  return p.x >= border && p.y >= border && p.x <= static_cast<float>(image.cols - 1) - border &&
         p.y <= static_cast<float>(image.rows - 1) - border;
}

/// Standard deviation of the window around `at`, grey levels.
double contrast(const cv::Mat& image, const cv::Point2f& at) {
  constexpr int kHalf = kWindow_px / 2;
  const cv::Rect window(static_cast<int>(std::lround(at.x)) - kHalf,
                        static_cast<int>(std::lround(at.y)) - kHalf, kWindow_px, kWindow_px);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(image(window & cv::Rect({0, 0}, image.size())), mean, deviation);
  return deviation[0];
}

/// Where Lucas–Kanade finds points again (eq. 2–8).
struct Flow {
  std::vector<cv::Point2f> to;
  std::vector<uint8_t> found;
  std::vector<float> difference;  ///< mean absolute difference of the windows, grey levels

  Flow(const std::vector<cv::Mat>& before, const std::vector<cv::Mat>& now,
       const std::vector<cv::Point2f>& from, std::vector<cv::Point2f> guess, int level)
      : to(std::move(guess)) {
    static const cv::TermCriteria kStop(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.01);
    cv::calcOpticalFlowPyrLK(before, now, from, to, found, difference,
                             cv::Size(kWindow_px, kWindow_px), level, kStop,
                             cv::OPTFLOW_USE_INITIAL_FLOW, kMinEigenvalue);
  }
};

/// Searches those of `features` that are not `found` yet, forwards, and back in the same way. Moves
/// and marks the found ones.
void follow_missing(const std::vector<cv::Mat>& before, const std::vector<cv::Mat>& now,
                    const PointSearch& search, std::vector<Feature>& features,
                    std::vector<bool>& found) {
  std::vector<size_t> missing;
  std::vector<cv::Point2f> from;
  std::vector<cv::Point2f> start;
  std::vector<cv::Point2f> guess;
  for (size_t i = 0; i < features.size(); ++i) {
    if (found[i]) continue;
    missing.push_back(i);
    from.push_back(features[i].at);
    start.push_back(search.expected ? features[i].moved : cv::Point2f());
    guess.push_back(from.back() + start.back());
  }
  if (missing.empty()) return;
  const Flow there(before, now, from, guess, search.level);
  for (size_t k = 0; k < missing.size(); ++k) guess[k] = there.to[k] - start[k];
  const Flow back(now, before, there.to, guess, search.level);
  for (size_t k = 0; k < missing.size(); ++k) {
    if (!there.found[k] || !back.found[k] || !is_inside(before[0], there.to[k])) continue;
    if (cv::norm(back.to[k] - from[k]) > kMaxReturn_px) continue;
    const double limit = std::max(kRounding, search.max_difference * contrast(before[0], from[k]));
    if (static_cast<double>(there.difference[k]) > limit) continue;
    features[missing[k]].moved = there.to[k] - from[k];
    features[missing[k]].at = there.to[k];
    found[missing[k]] = true;
  }
}

/// Both origins are at the centre of the first pixel.
ImagePoint in_frame(const cv::Point2f& reduced, int factor) {
  const auto scale = static_cast<float>(factor);
  return {(reduced.x + 0.5f) * scale - 0.5f, (reduced.y + 0.5f) * scale - 0.5f};
}

}  // namespace

struct OpenCvTracker::Impl {
  TrackerSettings settings;
  bool settings_changed = false;
  ReducedFrame reduced;
  std::vector<cv::Mat> before;  // levels of the pyramid, and their derivatives
  std::vector<cv::Mat> now;
  std::vector<Feature> features;
  uint32_t next_id = 0;
  size_t selected = 0;  // the points after the last selection
  int frames_since_selection = 0;
  OpenCvTracker::Result result;

  void track(const ImageView& frame, bool may_wait);
  bool follow();
  void set_still();
  bool selection_is_due() const;
  void select();
};

void OpenCvTracker::Impl::track(const ImageView& frame, bool may_wait) {
  result.picture = reduced.read(frame, may_wait);
  if (result.picture == FrameComparison::kSame) {
    if (!may_wait) set_still();
    return;
  }
  std::swap(before, now);
  constexpr bool kWithDerivatives = true;  // used twice: forwards from this picture, and back
  constexpr bool kReuseInput = false;      // the pyramid outlives the input
  cv::buildOpticalFlowPyramid(const_mat(reduced.base().view()), now,
                              cv::Size(kWindow_px, kWindow_px), kMaxPyramidLevel, kWithDerivatives,
                              cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, kReuseInput);
  result.points.clear();
  if (result.picture == FrameComparison::kFirst) {
    features.clear();
  } else if (!follow()) {
    reduced.cut();
    result.picture = FrameComparison::kFirst;
  }
  ++frames_since_selection;
  const bool begins = result.picture == FrameComparison::kFirst;
  if (begins || settings_changed || selection_is_due()) select();
  result.features = static_cast<int>(features.size());
}

/// Moves the features to the new picture and drops the lost ones. Returns false at a cut.
bool OpenCvTracker::Impl::follow() {
  std::vector<bool> found(features.size(), false);
  for (const PointSearch& search : kSearches) follow_missing(before, now, search, features, found);
  size_t kept = 0;
  for (size_t i = 0; i < features.size(); ++i) {
    if (!found[i]) continue;
    const Feature& feature = features[i];
    result.points.push_back({feature.id, in_frame(feature.at - feature.moved, reduced.factor()),
                             in_frame(feature.at, reduced.factor())});
    features[kept++] = feature;
  }
  const size_t looked_for = features.size();
  features.resize(kept);
  const bool is_cut = looked_for >= kMinForCut &&
                      static_cast<double>(kept) < kFoundAfterCut * static_cast<double>(looked_for);
  if (is_cut) {
    result.points.clear();
    features.clear();
  }
  return !is_cut;
}

void OpenCvTracker::Impl::set_still() {
  result.points.clear();
  for (const Feature& feature : features) {
    const ImagePoint at = in_frame(feature.at, reduced.factor());
    result.points.push_back({feature.id, at, at});
  }
}

bool OpenCvTracker::Impl::selection_is_due() const {
  return static_cast<double>(features.size()) < kThinnedOut * static_cast<double>(selected) ||
         frames_since_selection >= kSelectionInterval;
}

/// Selects the strongest corners of the picture (eq. 1). A corner near a followed point is that
/// point; a point without a corner is dropped. Thus a new object gets its share of the points.
void OpenCvTracker::Impl::select() {
  const cv::Mat& image = now[0];
  // Closer to the border the eigenvalues include mirrored pixels.
  const int border = std::max(border_px(image), kNeighbourhood_px / 2 + kSobel_px / 2);
  const cv::Rect middle(border, border, image.cols - 2 * border, image.rows - 2 * border);
  // A distance beyond the picture's diagonal has no further effect; the bound fits an int.
  const double apart_px =
      std::min(settings.min_distance_px * reduced.height() / kReferenceHeight_px / reduced.factor(),
               std::hypot(image.cols, image.rows));
  std::vector<cv::Point2f> corners;
  std::vector<float> responses;
  cv::goodFeaturesToTrack(image(middle), corners, kMaxFeatures,
                          std::max(settings.quality_level, kMinQualityLevel), apart_px,
                          cv::noArray(), responses, kNeighbourhood_px, kSobel_px);
  std::vector<Feature> known;
  known.swap(features);
  for (size_t i = 0; i < corners.size(); ++i) {
    if (static_cast<double>(responses[i]) < kMinResponse) continue;
    const cv::Point2f at = corners[i] + cv::Point2f(middle.tl());
    const auto is_nearer = [&](const Feature& a, const Feature& b) {
      return cv::norm(a.at - at) < cv::norm(b.at - at);
    };
    const auto nearest = std::min_element(known.begin(), known.end(), is_nearer);
    if (nearest != known.end() && cv::norm(nearest->at - at) < apart_px / 2) {
      features.push_back(*nearest);
      known.erase(nearest);
    } else {
      features.push_back({next_id++, at, {}});
    }
  }
  selected = features.size();
  frames_since_selection = 0;
  settings_changed = false;
}

OpenCvTracker::OpenCvTracker(const TrackerSettings& settings) : impl_(std::make_unique<Impl>()) {
  configure(settings);
}

OpenCvTracker::~OpenCvTracker() = default;

const OpenCvTracker::Result& OpenCvTracker::track(const ImageView& frame, bool may_wait) {
  require_usable(frame);
  run_on_this_thread([&] { impl_->track(frame, may_wait); });
  return impl_->result;
}

const OpenCvTracker::Result& OpenCvTracker::result() const {
  return impl_->result;
}

void OpenCvTracker::reset() {
  impl_->reduced.reset();
}

void OpenCvTracker::configure(const TrackerSettings& settings) {
  validate(settings);
  if (settings == impl_->settings) return;
  impl_->settings = settings;
  impl_->settings_changed = true;
}

void validate(const TrackerSettings& settings) {
  if (!(settings.quality_level >= 0 && settings.quality_level <= 1)) {
    throw std::invalid_argument("quality_level must be 0 to 1, got " +
                                std::to_string(settings.quality_level));
  }
  require_not_negative("min_distance_px", settings.min_distance_px);
}

}  // namespace spidar
