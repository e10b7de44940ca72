// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/systematics.h"

#include <algorithm>
#include <cmath>

#include "core/grip/singular_values.h"

namespace spidar {
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
