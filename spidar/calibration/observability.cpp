// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/observability.h"

#include <cmath>
#include <limits>

#include <Eigen/QR>
#include <Eigen/SVD>

namespace spidar {
namespace {

// Singular values below this share of the largest one are rounding errors.
constexpr double kRank = 1e-10;
// A quantity with a smaller coefficient does not count as part of a direction; coefficients are of
// the order of one.
constexpr double kTakesPart = 1e-6;

}  // namespace

Observability::Observability(int parameters)
    : root_(Eigen::MatrixXd::Zero(parameters, parameters)) {}

void Observability::add(const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 6>>& by_pose,
                        const Eigen::Ref<const Eigen::MatrixXd>& by_parameter, double weight) {
  const Eigen::Index redundant = by_pose.rows() - by_pose.cols();
  if (redundant <= 0) return;
  using Poses = Eigen::Matrix<double, Eigen::Dynamic, 6>;
  const Eigen::HouseholderQR<Poses> elimination(by_pose);
  const Eigen::MatrixXd rotated = elimination.householderQ().adjoint() * by_parameter;

  const Eigen::Index size = root_.cols();
  Eigen::MatrixXd stacked(size + redundant, size);
  stacked << root_, std::sqrt(weight) * rotated.bottomRows(redundant);
  const Eigen::HouseholderQR<Eigen::MatrixXd> update(stacked);
  root_ = update.matrixQR().topRows(size).triangularView<Eigen::Upper>();
}

Observability::Directions Observability::directions() const {
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd(root_,
                                                                         Eigen::ComputeFullV);
  const Eigen::VectorXd& singular = svd.singularValues();
  Directions found;
  found.directions = svd.matrixV().rowwise().reverse();
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

}  // namespace spidar
