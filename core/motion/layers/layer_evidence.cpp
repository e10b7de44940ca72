// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/layers/layer_evidence.h"

#include <algorithm>
#include <initializer_list>

namespace spidar {
namespace {

/// Mean speed on the screen over mean change of the relative velocity: below this the former is an
/// error. Means, so that a single jump, as where a picture was left out of the film, is no shake.
constexpr double kOnScreen = 0.4;

/// In this share of the frames a region stands out if it is more than a layer that does so by
/// chance now and then.
constexpr double kMostFrames = 0.5;

}  // namespace

void LayerEvidence::add(const Eigen::Vector2d& relative_px_s,
                        const Eigen::Vector2d& background_px_s, double interval_s) {
  const double share = std::min(1.0, interval_s / kMean_s);
  if (seen_s_ > 0) {
    const Eigen::Vector2d screen_px_s = relative_px_s + background_px_s;
    screen_px_s_ += share * (screen_px_s.norm() - screen_px_s_);
    changes_px_s_ += share * ((relative_px_s - newest_px_s_).norm() - changes_px_s_);
  }
  newest_px_s_ = relative_px_s;
  const double newest = seen_s_ == 0 ? 1 : share;
  relative_px_s_ += newest * (relative_px_s - relative_px_s_);
  background_px_s_ += newest * (background_px_s - background_px_s_);
  seen_s_ += interval_s;
  if (seen_s_ >= kMean_s) least_ratio_ = std::min(least_ratio_, mean_ratio());
}

void LayerEvidence::add_contrast(bool stands_out) {
  ++contrasts_;
  stood_out_ += stands_out;
}

double LayerEvidence::mean_ratio() const {
  const double relative_px_s = relative_px_s_.norm();
  // Without any motion of its own nothing shows that a region is more than a layer.
  constexpr double kLeast_px_s = 1e-6;
  return (relative_px_s_ + background_px_s_).norm() / std::max(relative_px_s, kLeast_px_s);
}

bool LayerEvidence::is_on_screen() const {
  return screen_px_s_ < kOnScreen * changes_px_s_;
}

bool LayerEvidence::mostly_stood_out() const {
  return stood_out_ >= kMostFrames * contrasts_;
}

double LayerEvidence::ratio() const {
  return std::min(mean_ratio(), least_ratio_);
}

}  // namespace spidar
