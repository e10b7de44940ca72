// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/observability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grip/singular_values.h"

namespace spidar {
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

}  // namespace spidar
