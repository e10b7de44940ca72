// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/noise.h"

#include <algorithm>
#include <cmath>

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

}  // namespace spidar
