// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/motion_models.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace spidar {
namespace {

/// Sum of the weights, and weighted means of position and displacement.
struct Means {
  double weight = 0;
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d moved_px = Eigen::Vector2d::Zero();
};

Means means_of(const std::vector<Displacement>& points, const std::vector<double>& weights) {
  Means means;
  for (size_t i = 0; i < points.size(); ++i) {
    means.weight += weights[i];
    means.at_px += weights[i] * points[i].at_px;
    means.moved_px += weights[i] * points[i].moved_px;
  }
  if (means.weight > 0) {
    means.at_px /= means.weight;
    means.moved_px /= means.weight;
  }
  return means;
}

/// Relative to the means the shift cancels; the linear part remains.
bool fit_linear(const std::vector<Displacement>& points, const std::vector<double>& weights,
                const Means& means, MotionModel& model) {
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();  // Σ w q qᵀ
  Eigen::Matrix2d cross = Eigen::Matrix2d::Zero();    // Σ w d qᵀ
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d q = points[i].at_px - means.at_px;
    const Eigen::Vector2d d = points[i].moved_px - means.moved_px;
    scatter += weights[i] * q * q.transpose();
    cross += weights[i] * d * q.transpose();
  }
  // All are in one position, but for the rounding of their mean (1e-10 px at 1e4 px from the
  // centre).
  constexpr double kOnePlace_px = 1e-6;
  if (!(scatter.trace() > means.weight * kOnePlace_px * kOnePlace_px)) return false;
  if (model.kind == ModelKind::kSimilarity) {
    const double grow = cross.trace() / scatter.trace();
    const double turn = (cross(1, 0) - cross(0, 1)) / scatter.trace();
    model.linear << grow, -turn, turn, grow;
  } else {
    // The points lie almost on one line: a hundred times as long as wide.
    if (!(scatter.determinant() > 1e-4 * scatter.trace() * scatter.trace())) return false;
    model.linear = cross * scatter.inverse();
  }
  model.shift_px = means.moved_px - model.linear * means.at_px;
  return true;
}

/// H s = g for the Gauss–Newton step s of the eight parameters of a homography. In x only the first
/// three of them act, in y the next three, with the same derivatives `a`, and the last two act in
/// both, with `p_x` and `p_y`: what is zero, or there already, is not added up.
struct HomographySums {
  Eigen::Matrix3d aa = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 2, 3> pa_x = Eigen::Matrix<double, 2, 3>::Zero(), pa_y = pa_x;
  Eigen::Matrix2d pp = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 8, 1> g = Eigen::Matrix<double, 8, 1>::Zero();

  void add(double weight, const Eigen::Vector3d& a, const Eigen::Vector2d& p_x,
           const Eigen::Vector2d& p_y, const Eigen::Array2d& error) {
    const Eigen::RowVector3d wa = weight * a.transpose();
    aa += a * wa;
    pa_x += p_x * wa;
    pa_y += p_y * wa;
    pp += p_x * (weight * p_x.transpose());
    pp += p_y * (weight * p_y.transpose());
    g.segment<3>(0) += weight * (error.x() * a);
    g.segment<3>(3) += weight * (error.y() * a);
    g.segment<2>(6) += weight * (error.x() * p_x + error.y() * p_y);
  }

  /// The lower triangle of H.
  Eigen::Matrix<double, 8, 8> lower() const {
    Eigen::Matrix<double, 8, 8> H = decltype(H)::Zero();
    H.block<3, 3>(0, 0) = H.block<3, 3>(3, 3) = aa;
    H.block<2, 3>(6, 0) = pa_x;
    H.block<2, 3>(6, 3) = pa_y;
    H.block<2, 2>(6, 6) = pp;
    return H;
  }
};

/// Gauss–Newton steps from the affine solution.
bool refine_homography(const std::vector<Displacement>& points, const std::vector<double>& weights,
                       MotionModel& model) {
  constexpr int kGaussNewtonSteps = 4;
  constexpr double kSmall = 1e-2;   // px, at kUnit_px from the centre
  constexpr double kUnit_px = 256;  // lengths near 1, so that the normal matrix is well scaled
  for (int step = 0; step < kGaussNewtonSteps; ++step) {
    const double h_x = model.perspective_1_px.x(), h_y = model.perspective_1_px.y();
    const Eigen::Array2d shift = model.shift_px, column_x = model.linear.col(0),
                         column_y = model.linear.col(1);
    HomographySums sums;
    for (size_t i = 0; i < points.size(); ++i) {
      if (weights[i] == 0) continue;
      // MotionModel::displacement_px(), of which the divisor is used again.
      const double at_x = points[i].at_px.x(), at_y = points[i].at_px.y();
      const double divisor = 1 + (h_x * at_x + h_y * at_y);
      // The homography would map points behind the camera.
      if (!(divisor > 0.1)) return false;
      const Eigen::Array2d at = points[i].at_px,
                           moved = at + (shift + (column_x * at_x + column_y * at_y));
      const Eigen::Array2d to = at + (moved / divisor - at);
      const Eigen::Array2d error = points[i].moved_px.array() - (to - at);
      const Eigen::Array2d a = at / kUnit_px / divisor;
      const Eigen::Array2d p_x = -to.x() / kUnit_px * a, p_y = -to.y() / kUnit_px * a;
      sums.add(weights[i], {a.x(), a.y(), 1 / divisor}, p_x, p_y, error);
    }
    const Eigen::LDLT<Eigen::Matrix<double, 8, 8>, Eigen::Lower> ldlt(sums.lower());
    const auto pivots = ldlt.vectorD();
    if (!(pivots.minCoeff() > 1e-10 * pivots.maxCoeff())) return false;
    const Eigen::Matrix<double, 8, 1> change = ldlt.solve(sums.g);
    model.linear(0, 0) += change[0] / kUnit_px;
    model.linear(0, 1) += change[1] / kUnit_px;
    model.linear(1, 0) += change[3] / kUnit_px;
    model.linear(1, 1) += change[4] / kUnit_px;
    model.shift_px += Eigen::Vector2d(change[2], change[5]);
    model.perspective_1_px += Eigen::Vector2d(change[6], change[7]) / (kUnit_px * kUnit_px);
    // Each step squares the error in units of kUnit_px: less than 1e-6 px are left, and residuals
    // of a pixel add less than 1e-4 px.
    if (change.cwiseAbs().maxCoeff() < kSmall) break;
  }
  return true;
}

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

const char* to_string(ModelKind kind) {
  switch (kind) {
    case ModelKind::kStill:
      return "still";
    case ModelKind::kTranslation:
      return "translation";
    case ModelKind::kSimilarity:
      return "similarity";
    case ModelKind::kAffine:
      return "affine";
    case ModelKind::kHomography:
      return "homography";
  }
  return "unknown";
}

double MotionModel::roll_rad() const {
  return std::atan2((linear(1, 0) - linear(0, 1)) / 2, 1 + growth());
}

std::optional<MotionModel> fit_model(ModelKind kind, const std::vector<Displacement>& points,
                                     const std::vector<double>& weights) {
  MotionModel model;
  model.kind = kind;
  if (kind == ModelKind::kStill) return model;
  const Means means = means_of(points, weights);
  if (!(means.weight > 0)) return std::nullopt;
  if (kind == ModelKind::kTranslation) {
    model.shift_px = means.moved_px;
    return model;
  }
  if (!fit_linear(points, weights, means, model)) return std::nullopt;
  if (kind == ModelKind::kHomography && !refine_homography(points, weights, model)) {
    return std::nullopt;
  }
  return model;
}

double robust_cost(const MotionModel& model, const WeightedDisplacements& evidence) {
  return cost_within(evidence.sigma_px, model, evidence, 1e300);
}

RobustFitter::RobustFitter() {
  weights_.reserve(kMaxDisplacements);
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
  for (size_t k = 0; k < kMaxTries; ++k) {
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
