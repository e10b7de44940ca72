// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/robust_fit.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace spidar {
namespace {

/// The start may deviate by this, px of the field's picture, and each step tolerates half as much
/// as the one before, until the last one tolerates σ: a start is only as accurate as two points,
/// and a similarity where the scene needs more. With σ alone, the blocks of one object that move
/// alike often agree with a similarity that is more exact than any of the background's.
constexpr double kFar_px = 4.8;

/// The similarity that moves both points as they moved.
MotionModel through(const Displacement& a, const Displacement& b) {
  const Eigen::Vector2d q = b.at_px - a.at_px;
  const Eigen::Vector2d d = b.moved_px - a.moved_px;
  const double grow = d.dot(q) / q.squaredNorm();
  const double turn = (d.y() * q.x() - d.x() * q.y()) / q.squaredNorm();
  MotionModel model;
  model.kind = ModelKind::kSimilarity;
  model.linear << grow, -turn, turn, grow;
  model.shift_px = a.moved_px - model.linear * a.at_px;
  return model;
}

/// Σ w ρ with this σ. Stops when the sum exceeds `limit`, and then returns a value above it.
double cost_within(double sigma_px, const MotionModel& model, const WeightedDisplacements& evidence,
                   double limit) {
  double cost = 0;
  for (size_t i = 0; i < evidence.points.size() && cost <= limit; ++i) {
    cost += evidence.weights[i] * point_cost(model, evidence.points[i], sigma_px);
  }
  return cost;
}

}  // namespace

double robust_cost(const MotionModel& model, const WeightedDisplacements& evidence) {
  return cost_within(evidence.sigma_px, model, evidence, 1e300);
}

RobustFitter::RobustFitter() {
  weights_.reserve(kMostDisplacements);
}

MotionModel RobustFitter::start(const WeightedDisplacements& evidence,
                                const std::vector<MotionModel>& known) {
  MotionModel best;
  double least = 1e300;
  const double far_px = std::max(kFar_px, evidence.sigma_px);
  const auto consider = [&](const MotionModel& model) {
    const double cost = cost_within(far_px, model, evidence, least);
    if (!(cost < least)) return;
    least = cost;
    best = model;
  };
  for (const MotionModel& model : known) consider(model);
  const size_t n = evidence.points.size();
  if (n < 2) return best;
  // std::minstd_rand gives the same numbers on every machine; the distributions of <random> do not.
  std::minstd_rand random;
  for (size_t k = 0; k < kMostTries; ++k) {
    const Displacement& a = evidence.points[random() % n];
    const Displacement& b = evidence.points[random() % n];
    if (a.at_px != b.at_px) consider(through(a, b));
  }
  return best;
}

std::optional<MotionModel> RobustFitter::refine(ModelKind kind, const MotionModel& start,
                                                const WeightedDisplacements& evidence) {
  std::optional<MotionModel> model = start;
  if (kind == ModelKind::kStill) return MotionModel();
  weights_.resize(evidence.points.size());
  double tolerance_px = 2 * std::max(kFar_px, evidence.sigma_px);
  while (tolerance_px > evidence.sigma_px && model) {
    tolerance_px = std::max(evidence.sigma_px, tolerance_px / 2);
    const double reach_px = 2 * tolerance_px;
    for (size_t i = 0; i < weights_.size(); ++i) {
      const Displacement& point = evidence.points[i];
      const double e2 = (point.moved_px - model->displacement_px(point.at_px)).squaredNorm();
      const double w = 1 / (1 + e2 / (reach_px * reach_px));
      weights_[i] = evidence.weights[i] * w * w;
    }
    model = fit_model(kind, evidence.points, weights_);
  }
  return model;
}

}  // namespace spidar
