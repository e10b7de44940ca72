// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Votes for tests of BackgroundEstimator.
#pragma once

#include <vector>

#include "core/motion/camera/background.h"
#include "track_samples.h"

namespace spidar::test::background_votes {

constexpr int kWidth = 640;
constexpr int kHeight = 360;
/// Of a block's displacement.
constexpr double kSigma_px = 0.13;

/// Points of something 100 px wide at `at_px`, as far from the centre, that moves by `moved_px`.
inline void add_object(TrackSource& source, std::vector<Displacement>& points, int count,
                       const Eigen::Vector2d& at_px, const Eigen::Vector2d& moved_px,
                       double sigma_px) {
  MotionModel model;
  model.kind = ModelKind::kTranslation;
  model.shift_px = moved_px;
  for (int i = 0; i < count; ++i) {
    const double dx = source.uniform(-50, 50);
    const Eigen::Vector2d position = at_px + Eigen::Vector2d(dx, source.uniform(-50, 50));
    points.push_back(source.moved(model, position, sigma_px));
  }
}

/// Each point has one vote, two at the border, out of those of a picture with `blocks`.
inline BackgroundVotes votes(const std::vector<Displacement>& points, int blocks = 250) {
  constexpr double kBorder_px = 32;
  BackgroundVotes votes;
  votes.size_px << kWidth, kHeight;
  votes.all = blocks;
  for (const Displacement& point : points) {
    const Eigen::Vector2d from_middle_px = point.at_px.cwiseAbs();
    const bool at_border = from_middle_px.x() > kWidth / 2 - kBorder_px ||
                           from_middle_px.y() > kHeight / 2 - kBorder_px;
    const double weight = at_border ? kBorderVotes : 1;
    votes.cast.push_back({point, weight, at_border, votes.cast.size()});
  }
  return votes;
}

inline Background settle(BackgroundEstimator& estimator, TrackSource& source,
                         const MotionModel& truth, int frames, double sigma_px, int strays = 0) {
  Background background;
  for (int n = 0; n < frames; ++n) {
    auto points = source.moved(truth, 200 - strays, sigma_px);
    for (int i = 0; i < strays; ++i) points.push_back(source.stray());
    const BackgroundVotes given = votes(points);
    background = estimator.estimate(given);
    estimator.learn_noise(given, [](size_t) { return false; });
  }
  return background;
}

}  // namespace spidar::test::background_votes
