// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/motion_models.h"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace spidar {
namespace {

/// Whether points with this scatter, Σ w q qᵀ about their mean, lie almost on one line: a hundred
/// times as long as wide.
bool are_on_a_line(const Eigen::Matrix2d& scatter) {
  return !(scatter.determinant() > 1e-4 * scatter.trace() * scatter.trace());
}

/// Least squares of a model up to the affine one. `weight_of(i)` is called once for each point. The
/// sums are relative to `about_px`, which should be the middle of the points.
template <typename WeightOf>
std::optional<MotionModel> fit_linear(ModelKind kind, const std::vector<Displacement>& points,
                                      const Eigen::Vector2d& about_px, WeightOf&& weight_of) {
  MotionModel model;
  model.kind = kind;
  double weight = 0;
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero(), moved_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();  // Σ w q qᵀ
  Eigen::Matrix2d cross = Eigen::Matrix2d::Zero();    // Σ w d qᵀ
  for (size_t i = 0; i < points.size(); ++i) {
    const double w = weight_of(i);
    const Eigen::Vector2d q = points[i].at_px - about_px, wq = w * q;
    weight += w;
    moved_px += w * points[i].moved_px;
    if (kind == ModelKind::kTranslation) continue;
    at_px += wq;
    scatter += q * wq.transpose();
    cross += points[i].moved_px * wq.transpose();
  }
  if (!(weight > 0)) return std::nullopt;
  at_px /= weight;
  model.shift_px = moved_px /= weight;
  if (kind == ModelKind::kTranslation) return model;
  // Relative to the means the shift cancels; the linear part remains.
  scatter -= weight * at_px * at_px.transpose();
  cross -= weight * moved_px * at_px.transpose();
  // All points are in one position, but for the rounding of their mean: 1e-10 px at 1e4 px.
  constexpr double kOnePlace_px = 1e-6;
  if (!(scatter.trace() > weight * kOnePlace_px * kOnePlace_px)) return std::nullopt;
  if (kind == ModelKind::kSimilarity) {
    const double grow = cross.trace() / scatter.trace();
    const double turn = (cross(1, 0) - cross(0, 1)) / scatter.trace();
    model.linear << grow, -turn, turn, grow;
  } else {
    if (are_on_a_line(scatter)) return std::nullopt;
    model.linear = cross * scatter.inverse();
  }
  model.shift_px -= model.linear * (about_px + at_px);
  return model;
}

/// H s = g for the Gauss–Newton step s of the eight parameters of a homography, lengths in
/// kUnit_px. In x only the first three of them act, in y the next three, with the same derivatives
/// a = (x, y, 1) / divisor, and the last two act in both, with −to · (x, y) / divisor. Terms that
/// are zero or equal to others are not added up.
class HomographySums {
 public:
  static constexpr double kUnit_px = 256;  ///< makes the normal matrix well scaled

  void add(double weight, const Eigen::Array2d& at_px, double divisor, const Eigen::Array2d& to_px,
           const Eigen::Array2d& error_px) {
    const double x = at_px.x() / (kUnit_px * divisor), y = at_px.y() / (kUnit_px * divisor);
    const double one = 1 / divisor;
    const double wx = weight * x, wy = weight * y, w = weight * one;
    const Eigen::Array2d to = to_px / kUnit_px;
    Products products;
    products << wx * x, wx * y, wy * y, wx * one, wy * one, w * one;
    of_both_ += products;
    of_x_ += to.x() * products;
    of_y_ += to.y() * products;
    of_to_ += to.matrix().squaredNorm() * products;
    const Eigen::Array4d a(wx, wy, w, 0);
    g_x_ += error_px.x() * a;
    g_y_ += error_px.y() * a;
    g_to_ += (error_px * to).sum() * a;
  }

  /// s, without its unit; nothing where the points do not determine it.
  std::optional<Eigen::Matrix<double, 8, 1>> solve() const {
    const Eigen::Vector2d sum = of_both_.segment<2>(3);
    const Eigen::Matrix2d squares{{of_both_[0], of_both_[1]}, {of_both_[1], of_both_[2]}};
    if (are_on_a_line(squares - sum * sum.transpose() / of_both_[5])) return std::nullopt;
    Eigen::Matrix<double, 8, 8> H = decltype(H)::Zero();  // its lower triangle
    const auto rows_of = [](const Products& p) {
      return Eigen::Matrix3d{{p[0], p[1], p[3]}, {p[1], p[2], p[4]}, {p[3], p[4], p[5]}};
    };
    H.block<3, 3>(0, 0) = H.block<3, 3>(3, 3) = rows_of(of_both_);
    H.block<2, 3>(6, 0) = -rows_of(of_x_).topRows<2>();
    H.block<2, 3>(6, 3) = -rows_of(of_y_).topRows<2>();
    H.block<2, 2>(6, 6) = rows_of(of_to_).topLeftCorner<2, 2>();
    const Eigen::LDLT<Eigen::Matrix<double, 8, 8>, Eigen::Lower> ldlt(H);
    const auto pivots = ldlt.vectorD();
    if (!(pivots.minCoeff() > 1e-10 * pivots.maxCoeff())) return std::nullopt;
    Eigen::Matrix<double, 8, 1> g;
    g << g_x_.head<3>(), g_y_.head<3>(), -g_to_.head<2>();
    return ldlt.solve(g).eval();
  }

 private:
  using Products = Eigen::Array<double, 6, 1>;  ///< w a aᵀ: of x x, x y, y y, x 1, y 1, 1 1

  Products of_both_ = Products::Zero(), of_x_ = of_both_, of_y_ = of_both_, of_to_ = of_both_;
  Eigen::Array4d g_x_ = Eigen::Array4d::Zero(), g_y_ = g_x_, g_to_ = g_x_;
};

/// One Gauss–Newton step. `weight_of(i, e²)` is called once for each point, with the square of its
/// residual displacement. Returns false where the points do not determine the step.
template <typename WeightOf>
bool step_homography(const std::vector<Displacement>& points, MotionModel& model,
                     WeightOf&& weight_of) {
  const double h_x = model.perspective_1_px.x(), h_y = model.perspective_1_px.y();
  const Eigen::Array2d shift = model.shift_px, column_x = model.linear.col(0),
                       column_y = model.linear.col(1);
  HomographySums sums;
  for (size_t i = 0; i < points.size(); ++i) {
    // MotionModel::displacement_px(), whose divisor is used again.
    const Eigen::Array2d at = points[i].at_px;
    const double divisor = 1 + (h_x * at.x() + h_y * at.y());
    const Eigen::Array2d moved = at + (shift + (column_x * at.x() + column_y * at.y()));
    const Eigen::Array2d to = at + (moved / divisor - at);
    const Eigen::Array2d error = points[i].moved_px.array() - (to - at);
    const double weight = weight_of(i, error.matrix().squaredNorm());
    if (weight == 0) continue;
    // The homography would map points behind the camera.
    if (!(divisor > 0.1)) return false;
    sums.add(weight, at, divisor, to, error);
  }
  const auto step = sums.solve();
  if (!step) return false;
  const Eigen::Matrix<double, 8, 1>& by = *step;
  constexpr double kUnit_px = HomographySums::kUnit_px;
  model.linear += Eigen::Matrix2d{{by[0], by[1]}, {by[3], by[4]}} / kUnit_px;
  model.shift_px += Eigen::Vector2d(by[2], by[5]);
  model.perspective_1_px += Eigen::Vector2d(by[6], by[7]) / (kUnit_px * kUnit_px);
  return true;
}

/// The tolerance of the first step, px of the field's picture. Each step tolerates half as much as
/// the one before, until the last one tolerates σ: a start is only as accurate as two points, and a
/// similarity where the scene needs more. With σ alone, the blocks of one object that move alike
/// often agree with a similarity that is more exact than any of the background's.
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

double robust_cost(const MotionModel& model, const WeightedDisplacements& evidence) {
  return cost_within(evidence.sigma_px, model, evidence, 1e300);
}

MotionModel find_start(const WeightedDisplacements& evidence,
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

std::optional<MotionModel> fit_robustly(ModelKind kind, const MotionModel& start,
                                        const WeightedDisplacements& evidence) {
  if (kind == ModelKind::kStill) return MotionModel();
  const std::vector<Displacement>& points = evidence.points;
  double weight = 0;
  Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
  for (size_t i = 0; i < points.size(); ++i) {
    weight += evidence.weights[i];
    middle_px += evidence.weights[i] * points[i].at_px;
  }
  if (!(weight > 0)) return std::nullopt;
  middle_px /= weight;
  std::optional<MotionModel> model = start;
  double tolerance_px = 2 * std::max(kFar_px, evidence.sigma_px);
  while (tolerance_px > evidence.sigma_px && model) {
    tolerance_px = std::max(evidence.sigma_px, tolerance_px / 2);
    const double of_reach_1_px2 = 1 / (4 * tolerance_px * tolerance_px);
    const auto weight_of = [&](size_t i, double e2) {
      const double w = 1 / (1 + e2 * of_reach_1_px2);
      return evidence.weights[i] * w * w;
    };
    if (kind == ModelKind::kHomography) {
      model->kind = kind;
      if (!step_homography(points, *model, weight_of)) model.reset();
      continue;
    }
    const MotionModel last = *model;
    model = fit_linear(kind, points, middle_px, [&](size_t i) {
      const Eigen::Vector2d expected_px = last.displacement_px(points[i].at_px);
      return weight_of(i, (points[i].moved_px - expected_px).squaredNorm());
    });
  }
  return model;
}

}  // namespace spidar
