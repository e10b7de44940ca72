// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grip/singular_values.h"
#include "core/quantile.h"

namespace spidar {
namespace {

constexpr double kMaxCorrelation = 0.9999;

}  // namespace

double median(Eigen::VectorXd values) {
  return median(values.data(), values.data() + values.size());
}

double robust_sigma_m(const Eigen::VectorXd& norms_m, int redundant, int parameters,
                      double floor_m) {
  const double errors = redundant * static_cast<double>(norms_m.size());
  if (errors <= parameters) return floor_m;
  const double median_of_chi = redundant == 1 ? 0.6745 : std::sqrt(2 * std::log(2.0));
  const double left = std::sqrt((errors - parameters) / errors);
  return std::max(floor_m, median(norms_m) / median_of_chi / left);
}

double correlation_factor(const Eigen::MatrixXd& errors, const Eigen::VectorXd& weights,
                          int redundant) {
  const Eigen::MatrixXd weighted = weights.asDiagonal() * errors;
  const Eigen::Index pairs = weighted.rows() - 1;
  if (pairs < 1) return 1;
  const double total = weighted.squaredNorm();
  if (!(total > 0)) return 1;
  const double product = weighted.topRows(pairs).cwiseProduct(weighted.bottomRows(pairs)).sum();
  const double correlation = product / total;
  // Three standard deviations of the correlation of independent errors.
  const double chance = 3 / std::sqrt(static_cast<double>(redundant * pairs));
  if (correlation <= chance) return 1;
  const double bounded = std::min(correlation, kMaxCorrelation);
  return std::sqrt((1 + bounded) / (1 - bounded));
}

namespace {

// Singular values below this share of the largest one are rounding errors.
constexpr double kRank = 1e-10;
// A quantity with a smaller coefficient does not count as part of a direction; coefficients are of
// the order of one.
constexpr double kTakesPart = 1e-6;

}  // namespace

Observability::Observability(int parameters) : parameters_(parameters) {}

void Observability::add(const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 6>>& by_pose,
                        const Eigen::Ref<const Eigen::MatrixXd>& by_parameter, double weight) {
  const Eigen::MatrixXd unexplained = singular_values(by_pose.transpose()).directions;
  for (Eigen::Index i = by_pose.cols(); i < by_pose.rows(); ++i)
    rows_.push_back(std::sqrt(weight) * by_parameter.transpose() * unexplained.col(i));
}

Observability::Directions Observability::directions() const {
  Eigen::MatrixXd root =
      Eigen::MatrixXd::Zero(std::max(parameters_, static_cast<int>(rows_.size())), parameters_);
  for (size_t i = 0; i < rows_.size(); ++i) root.row(static_cast<Eigen::Index>(i)) = rows_[i];
  const auto [singular, V] = singular_values(root);
  Directions found;
  found.directions = V.rowwise().reverse();
  found.sd.resize(singular.size());
  for (Eigen::Index i = 0; i < singular.size(); ++i) {
    const double information = singular[singular.size() - 1 - i];
    found.sd[i] = information > kRank * singular[0] ? 1 / information
                                                    : std::numeric_limits<double>::infinity();
  }
  return found;
}

Eigen::VectorXd standard_deviations(const Observability::Directions& directions,
                                    const Eigen::MatrixXd& quantities) {
  const Eigen::MatrixXd parts = quantities * directions.directions;
  Eigen::VectorXd sd(parts.rows());
  for (Eigen::Index row = 0; row < parts.rows(); ++row) {
    double variance = 0;
    for (Eigen::Index i = 0; i < parts.cols(); ++i)
      if (std::abs(parts(row, i)) > kTakesPart)
        variance += std::pow(parts(row, i) * directions.sd[i], 2);
    sd[row] = std::sqrt(variance);
  }
  return sd;
}

namespace {

constexpr int kNoiseRounds = 5;
/// Prior of each estimated parameter. No offset is off by this much, so it adds no information but
/// keeps the problem solvable where the motion does not determine a parameter.
constexpr double kUnknown_m = 1.0;

/// Numbers of the profile that are not estimated: a scale for each string, then the exits unless
/// they are estimated, then the points on the grip.
class FixedNumbers {
 public:
  explicit FixedNumbers(const CalibrationModel& model)
      : strings_(model.strings()), exits_(model.exit_row() < 0) {}

  int size() const { return strings_ * (exits_ ? 7 : 4); }

  Eigen::VectorXd sd() const {
    Eigen::VectorXd all = Eigen::VectorXd::Constant(size(), kPointError_m);
    all.head(strings_).setConstant(kScaleError);
    return all;
  }

  /// Derivatives of CalibrationModel::length_errors_m(), one row for each string.
  Eigen::MatrixXd derivatives(const CalibrationModel& model, const Eigen::VectorXd& parameters,
                              const StringVector& paid_out_m, const Pose& pose) const {
    // A string gets longer when its exit moves away from the grip, and shorter when its point on
    // the grip moves towards the exit.
    const StructureMatrix W = structure_matrix(model.geometry(parameters), pose);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(strings_, size());
    for (int i = 0; i < strings_; ++i) {
      const Eigen::RowVector3d direction = W.col(i).head<3>().transpose();
      all(i, i) = -model.scale(parameters) * paid_out_m[i];
      if (exits_) all.block<1, 3>(i, strings_ + 3 * i) = direction;
      all.block<1, 3>(i, size() - 3 * (strings_ - i)) = -direction * pose.orientation.matrix();
    }
    return all;
  }

 private:
  const int strings_;
  const bool exits_;
};

}  // namespace

StringVector offset_uncertainty_m(const CalibrationModel& model,
                                  const std::vector<StringVector>& paid_out_m, const Bundle& bundle,
                                  const Eigen::VectorXd& weights, double noise_m, double floor_m) {
  const FixedNumbers fixed(model);
  const int estimated = model.size(), size = estimated + fixed.size();
  const int redundant = model.strings() - 6;
  Eigen::VectorXd prior_sd(size);
  prior_sd << Eigen::VectorXd::Constant(estimated, kUnknown_m), fixed.sd();

  // In units of the prior, so that the numbers are of similar size. The last row and column hold
  // the errors.
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size + 1, size + 1);
  Eigen::MatrixXd rows(model.strings(), size + 1);
  for (size_t k = 0; k < paid_out_m.size(); ++k) {
    CalibrationModel::Derivatives d;
    const Eigen::VectorXd error_m =
        model.length_errors_m(bundle.parameters, paid_out_m[k], bundle.poses[k], &d);
    rows << d.by_parameter,
        fixed.derivatives(model, bundle.parameters, paid_out_m[k], bundle.poses[k]), error_m;
    rows.leftCols(size) *= prior_sd.asDiagonal();
    // The part that no change of the pose explains.
    const Eigen::MatrixXd left =
        singular_values(d.by_twist.transpose()).directions.rightCols(redundant).transpose() * rows;
    normal.noalias() += weights[static_cast<Eigen::Index>(k)] * left.transpose() * left;
  }

  // Without the prior, the information is V diag(values) Vᵀ / noise², and the prior adds the
  // identity.
  const SingularValues known = singular_values(normal.topLeftCorner(size, size));
  const Eigen::MatrixXd& V = known.directions;
  const Eigen::VectorXd toward = normal.col(size).head(size);
  const double degrees = redundant * weights.sum() - size;
  Eigen::VectorXd change(size), variance(size);
  for (int round = 0; round < kNoiseRounds; ++round) {
    const double variance_m2 = noise_m * noise_m;
    const Eigen::VectorXd spread = (known.values.array() / variance_m2 + 1).inverse();
    change = -V * spread.cwiseProduct(V.transpose() * (toward / variance_m2));
    variance = V.cwiseAbs2() * spread;
    const double squares_m2 = normal(size, size) + 2 * toward.dot(change) +
                              change.dot(normal.topLeftCorner(size, size) * change);
    if (degrees > 0) noise_m = std::max(floor_m, std::sqrt(std::max(squares_m2, 0.0) / degrees));
  }
  StringVector uncertainty_m = StringVector::Zero();
  for (int i = 0; i < model.strings(); ++i)
    uncertainty_m[i] = prior_sd[i] * std::sqrt(change[i] * change[i] + variance[i]);
  return uncertainty_m;
}

}  // namespace spidar
