// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/motion_models.h"

#include <cmath>

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

/// The sums of a Gauss–Newton step for the eight parameters of a homography. In x only the first
/// three of them act, in y the next three, with the same derivatives, and the last two act in both:
/// what is zero, or there already, is not added up.
class NormalEquations {
 public:
  using Vector8 = Eigen::Matrix<double, 8, 1>;
  using Matrix8 = Eigen::Matrix<double, 8, 8>;

  /// `a` are the derivatives of the coordinates by three parameters each; `px` and `py` those of
  /// x and of y by the perspective.
  void add(double weight, const double (&a)[3], const double (&px)[2], const double (&py)[2],
           double error_x, double error_y) {
    for (int i = 0; i < 3; ++i) {
      const double wa = weight * a[i];
      for (int j = i; j < 3; ++j) affine_[i][j] += wa * a[j];
      for (int k = 0; k < 2; ++k) {
        with_x_[i][k] += wa * px[k];
        with_y_[i][k] += wa * py[k];
      }
      right_[i] += weight * (error_x * a[i]);
      right_[3 + i] += weight * (error_y * a[i]);
    }
    for (int k = 0; k < 2; ++k) {
      const double wx = weight * px[k], wy = weight * py[k];
      for (int l = k; l < 2; ++l) {
        perspective_[k][l] += wx * px[l];
        perspective_[k][l] += wy * py[l];
      }
      right_[6 + k] += weight * (error_x * px[k] + error_y * py[k]);
    }
  }

  /// The lower triangle.
  Matrix8 matrix() const {
    Matrix8 lower = Matrix8::Zero();
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) lower(j, i) = lower(3 + j, 3 + i) = affine_[i][j];
      for (int k = 0; k < 2; ++k) {
        lower(6 + k, i) = with_x_[i][k];
        lower(6 + k, 3 + i) = with_y_[i][k];
      }
    }
    for (int k = 0; k < 2; ++k) {
      for (int l = k; l < 2; ++l) lower(6 + l, 6 + k) = perspective_[k][l];
    }
    return lower;
  }
  Vector8 right() const { return Eigen::Map<const Vector8>(right_); }

 private:
  double affine_[3][3] = {};
  double with_x_[3][2] = {};
  double with_y_[3][2] = {};
  double perspective_[2][2] = {};
  double right_[8] = {};
};

/// Gauss–Newton steps from the affine solution.
bool refine_homography(const std::vector<Displacement>& points, const std::vector<double>& weights,
                       MotionModel& model) {
  constexpr int kGaussNewtonSteps = 4;
  constexpr double kSmall = 1e-2;   // px, at kUnit_px from the centre
  constexpr double kUnit_px = 256;  // lengths near 1, so that the normal matrix is well scaled
  using Vector8 = NormalEquations::Vector8;
  for (int step = 0; step < kGaussNewtonSteps; ++step) {
    const double h_x = model.perspective_1_px.x(), h_y = model.perspective_1_px.y();
    const Eigen::Array2d shift = model.shift_px, column_x = model.linear.col(0),
                         column_y = model.linear.col(1);
    NormalEquations equations;
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
      const Eigen::Array2d px = -to.x() / kUnit_px * a, py = -to.y() / kUnit_px * a;
      equations.add(weights[i], {a.x(), a.y(), 1 / divisor}, {px.x(), px.y()}, {py.x(), py.y()},
                    error.x(), error.y());
    }
    const Eigen::LDLT<NormalEquations::Matrix8, Eigen::Lower> ldlt(equations.matrix());
    const Vector8 pivots = ldlt.vectorD();
    if (!(pivots.minCoeff() > 1e-10 * pivots.maxCoeff())) return false;
    const Vector8 change = ldlt.solve(equations.right());
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

}  // namespace spidar
