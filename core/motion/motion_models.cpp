// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/motion_models.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace spidar {
namespace {

/// Sum of the weights, and weighted means of place and displacement.
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

/// Points closer together than this do not determine rotation and growth, px rms.
constexpr double kLeastSpread_px = 1;

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
  const double spread_px2 = scatter.trace() / means.weight;
  if (!(spread_px2 > kLeastSpread_px * kLeastSpread_px)) return false;
  if (model.kind == ModelKind::kSimilarity) {
    const double grow = cross.trace() / scatter.trace();
    const double turn = (cross(1, 0) - cross(0, 1)) / scatter.trace();
    model.linear << grow, -turn, turn, grow;
  } else {
    const double determinant = scatter.determinant();
    // The points lie almost on one line: a hundred times as long as wide.
    if (!(determinant > 1e-4 * scatter.trace() * scatter.trace())) return false;
    Eigen::Matrix2d adjugate;
    adjugate << scatter(1, 1), -scatter(0, 1), -scatter(1, 0), scatter(0, 0);
    model.linear = cross * adjugate / determinant;
  }
  model.shift_px = means.moved_px - model.linear * means.at_px;
  return true;
}

/// Gauss–Newton steps from the affine solution.
bool refine_homography(const std::vector<Displacement>& points, const std::vector<double>& weights,
                       MotionModel& model) {
  constexpr int kSteps = 4;
  constexpr double kSmall = 1e-5;   // px, at kUnit_px from the centre
  constexpr double kUnit_px = 256;  // lengths near 1, so that the normal matrix is well scaled
  using Vector8 = Eigen::Matrix<double, 8, 1>;
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix<double, 8, 8> normal = Eigen::Matrix<double, 8, 8>::Zero();
    Vector8 right = Vector8::Zero();
    for (size_t i = 0; i < points.size(); ++i) {
      if (weights[i] == 0) continue;
      const Eigen::Vector2d& at = points[i].at_px;
      const double divisor = 1 + model.perspective_1_px.dot(at);
      // The homography would map points behind the camera.
      if (!(divisor > 0.1)) return false;
      const Eigen::Vector2d to = at + model.displacement_px(at);
      const Eigen::Vector2d error = points[i].moved_px - (to - at);
      const double x = at.x() / kUnit_px / divisor;
      const double y = at.y() / kUnit_px / divisor;
      Vector8 jx;
      jx << x, y, 1 / divisor, 0, 0, 0, -to.x() / kUnit_px * x, -to.x() / kUnit_px * y;
      Vector8 jy;
      jy << 0, 0, 0, x, y, 1 / divisor, -to.y() / kUnit_px * x, -to.y() / kUnit_px * y;
      normal.selfadjointView<Eigen::Lower>().rankUpdate(jx, weights[i]);
      normal.selfadjointView<Eigen::Lower>().rankUpdate(jy, weights[i]);
      right += weights[i] * (error.x() * jx + error.y() * jy);
    }
    const Eigen::LDLT<Eigen::Matrix<double, 8, 8>, Eigen::Lower> ldlt(normal);
    const Vector8 pivots = ldlt.vectorD();
    if (!(pivots.minCoeff() > 1e-10 * pivots.maxCoeff())) return false;
    const Vector8 change = ldlt.solve(right);
    model.linear(0, 0) += change[0] / kUnit_px;
    model.linear(0, 1) += change[1] / kUnit_px;
    model.linear(1, 0) += change[3] / kUnit_px;
    model.linear(1, 1) += change[4] / kUnit_px;
    model.shift_px += Eigen::Vector2d(change[2], change[5]);
    model.perspective_1_px += Eigen::Vector2d(change[6], change[7]) / (kUnit_px * kUnit_px);
    // Each step squares the error.
    if (change.cwiseAbs().maxCoeff() < kSmall) break;
  }
  return true;
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

void displacements(const std::vector<Track>& tracks, int width, int height,
                   std::vector<Displacement>& result) {
  // The centre of the first pixel is (0, 0).
  const Eigen::Vector2d centre((width - 1) / 2.0, (height - 1) / 2.0);
  const size_t step = tracks.size() / (kMostDisplacements + 1) + 1;
  result.clear();
  for (size_t i = 0; i < tracks.size(); i += step) {
    const Eigen::Vector2d from =
        Eigen::Vector2f(tracks[i].from.x_px, tracks[i].from.y_px).cast<double>();
    const Eigen::Vector2d to = Eigen::Vector2f(tracks[i].to.x_px, tracks[i].to.y_px).cast<double>();
    result.push_back({tracks[i].id, from - centre, to - from});
  }
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

}  // namespace spidar
