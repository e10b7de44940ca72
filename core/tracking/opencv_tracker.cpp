// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/opencv_tracker.h"

#include <utility>

#include <opencv2/core.hpp>

#include "core/tracking/luma_reduce.h"
#include "core/tracking/luma_row.h"
#include "core/tracking/point_flow.h"
#include "core/tracking/point_selection.h"
#include "core/tracking/repeated_picture.h"
#include "core/tracking/serial_opencv.h"

namespace spidar {
namespace {

/// Points followed at once, as in the usual examples of Lucas–Kanade.
constexpr int kMostFeatures = 200;

/// New points are selected when fewer than this share of those selected last are left …
constexpr double kThinnedOut = 0.7;
/// … and after this many frames in any case, because something may have entered.
constexpr int kSelectionInterval = 5;

/// A cut is detected when at least kMinForCut points were searched and less than this share was
/// found. With fewer points, the loss of a small object is more likely.
constexpr double kFoundAfterCut = 0.1;
constexpr size_t kMinForCut = 10;

}  // namespace

struct OpenCvTracker::Impl {
  TrackerSettings settings;
  bool settings_changed = false;

  int width = 0;  // of the previous frame; 0 if there is none
  int height = 0;
  FlowPyramid before;
  FlowPyramid now;
  RepeatedPicture repeated_picture;
  std::vector<uint8_t> in_bytes;  // the frame, if it has more than 8 bits
  cv::Mat response;               // buffer of the selection
  std::vector<Feature> features;  // in the reduced picture
  uint32_t next_id = 0;
  size_t selected = 0;  // points after the last selection
  int frames_since_selection = 0;

  TrackedFrame result;

  void track(const ImageView& frame, bool may_wait);
  PictureKind compare(bool may_wait);
  bool follow(int factor);
  void stand_still(int factor);
  bool selection_is_due() const;
  void select(int factor);
};

PictureKind OpenCvTracker::Impl::compare(bool may_wait) {
  const auto view = [](const cv::Mat& image) {
    return ImageView{image.data, image.cols, image.rows, static_cast<ptrdiff_t>(image.step[0])};
  };
  const PictureKind kind = repeated_picture.look(view(before[0]), view(now[0]));
  return kind == PictureKind::kAlike && may_wait ? PictureKind::kSame : kind;
}

void OpenCvTracker::Impl::track(const ImageView& frame, bool may_wait) {
  const int factor = reduction_factor(frame.width, frame.height);
  const bool comparable = frame.width == width && frame.height == height;
  if (!comparable) features.clear();
  width = frame.width;
  height = frame.height;

  std::swap(before, now);
  cv::Mat reduced;
  reduce_luma(in_8_bits(frame, in_bytes), factor, reduced);
  build_pyramid(reduced, now);

  if (!comparable) repeated_picture.restart();
  result.picture = comparable ? compare(may_wait) : PictureKind::kFirst;
  if (result.picture == PictureKind::kSame) {
    std::swap(before, now);
    if (!may_wait) stand_still(factor);
    return;
  }
  result.tracks.clear();
  if (comparable && !follow(factor)) result.picture = PictureKind::kFirst;
  ++frames_since_selection;
  const bool begins = result.picture == PictureKind::kFirst;
  if (begins || settings_changed || selection_is_due()) select(factor);
  result.features = static_cast<int>(features.size());
}

/// Moves the features to the new picture and drops the lost ones. Returns false at a cut.
bool OpenCvTracker::Impl::follow(int factor) {
  std::vector<PointFlow> flow;
  for (const Feature& feature : features) flow.push_back({feature.at, feature.moved, {}, false});
  follow_points(before, now, flow);

  const auto in_frame = [factor](const ImagePoint& p) {
    return ImagePoint{to_frame_px(p.x_px, factor), to_frame_px(p.y_px, factor)};
  };
  const size_t looked_for = features.size();
  size_t kept = 0;
  for (size_t i = 0; i < looked_for; ++i) {
    const PointFlow& point = flow[i];
    if (!point.found) continue;
    result.tracks.push_back({features[i].id, in_frame(point.from), in_frame(point.to)});
    const ImagePoint moved{point.to.x_px - point.from.x_px, point.to.y_px - point.from.y_px};
    features[kept++] = {features[i].id, point.to, moved};
  }
  features.resize(kept);

  const bool cut = looked_for >= kMinForCut &&
                   static_cast<double>(kept) < kFoundAfterCut * static_cast<double>(looked_for);
  if (cut) {
    result.tracks.clear();
    features.clear();
  }
  return !cut;
}

void OpenCvTracker::Impl::stand_still(int factor) {
  result.tracks.clear();
  for (const Feature& feature : features) {
    const ImagePoint at{to_frame_px(feature.at.x_px, factor), to_frame_px(feature.at.y_px, factor)};
    result.tracks.push_back({feature.id, at, at});
  }
}

bool OpenCvTracker::Impl::selection_is_due() const {
  return static_cast<double>(features.size()) < kThinnedOut * static_cast<double>(selected) ||
         frames_since_selection >= kSelectionInterval;
}

void OpenCvTracker::Impl::select(int factor) {
  SelectionSettings selection;
  selection.max_features = kMostFeatures;
  selection.quality_level = settings.quality_level;
  selection.min_distance_px = settings.min_distance_px * height / kReferenceHeight_px / factor;
  selection.border_px = follow_border_px(now[0]);
  select_features(now[0], selection, response, features, next_id);
  selected = features.size();
  frames_since_selection = 0;
  settings_changed = false;
}

OpenCvTracker::OpenCvTracker(const TrackerSettings& settings) : impl_(std::make_unique<Impl>()) {
  configure(settings);
}

OpenCvTracker::~OpenCvTracker() = default;

const TrackedFrame& OpenCvTracker::track(const ImageView& frame, bool may_wait) {
  require_usable(frame);
  run_on_this_thread([&] { impl_->track(frame, may_wait); });
  return impl_->result;
}

void OpenCvTracker::restart() {
  impl_->width = 0;
  impl_->height = 0;
}

void OpenCvTracker::configure(const TrackerSettings& settings) {
  validate(settings);
  if (settings == impl_->settings) return;
  impl_->settings = settings;
  impl_->settings_changed = true;
}

}  // namespace spidar
