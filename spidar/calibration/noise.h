// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Estimates the noise from the errors that remain after a fit.
#pragma once

#include <Eigen/Core>

namespace spidar {

double median(Eigen::VectorXd values);

/// Standard deviation of one length, estimated from the norms of the samples' errors; up to half of
/// them may be arbitrary. The norm of a good sample is σ times the root of χ² with `redundant`
/// degrees of freedom, one or two, of which the median is 0.6745 or √(2 ln 2). `parameters` were
/// fitted to all samples. Not less than `floor_m`.
double robust_sigma_m(const Eigen::VectorXd& norms_m, int redundant, int parameters,
                      double floor_m);

/// Factor by which standard deviations grow because errors of successive samples (rows) are
/// correlated, as those of a wrong model are. Computed as for a first-order autoregression with
/// their correlation. It is one if the correlation is no larger than by chance.
double correlation_factor(const Eigen::MatrixXd& errors, const Eigen::VectorXd& weights,
                          int redundant);

}  // namespace spidar
