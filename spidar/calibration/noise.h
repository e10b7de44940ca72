// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the errors that are left after a fit say about the noise.
#pragma once

#include <Eigen/Core>

namespace spidar {

double median(Eigen::VectorXd values);

/// Standard deviation of one length from the norms of the samples' errors, whatever half of them
/// says. A good sample's norm is σ times the root of χ² with `redundant` degrees of freedom, one or
/// two, of which the median is 0.6745 or √(2 ln 2). `parameters` were fitted to all samples. Not
/// less than `floor_m`.
double robust_sigma_m(const Eigen::VectorXd& norms_m, int redundant, int parameters,
                      double floor_m);

/// By how much standard deviations grow because errors of successive samples (rows) are alike,
/// which those of a wrong model are: as for a first-order autoregression of their correlation. One
/// when there is no more of it than chance gives.
double correlation_factor(const Eigen::MatrixXd& errors, const Eigen::VectorXd& weights,
                          int redundant);

}  // namespace spidar
