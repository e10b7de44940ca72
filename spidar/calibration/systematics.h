// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Effect on calibration of errors in those numbers of the profile that it does not estimate.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "spidar/calibration/bundle_adjustment.h"
#include "spidar/calibration/model.h"

namespace spidar {

/// Assumed errors of the profile's numbers (standard deviations): the accuracy of a ruler, and that
/// of the diameter of a drum or the stretch of a string.
inline constexpr double kPointError_m =
    1e-3;                                    ///< of a coordinate of an exit, of a point on the grip
inline constexpr double kScaleError = 5e-3;  ///< of each string's metres_per_count

/// Expected root mean square errors of the offsets if exits (unless they are estimated), points on
/// the grip and each string's scale have the errors above a priori, and given the errors that
/// remain after the fit.
///
/// These numbers join the estimated ones in a linear least squares problem at the fit, with their
/// standard deviations as a prior. Its solution is the probable error of the offsets, and its
/// covariance the part that remains unknown; the result is the root of the sum of squares of both.
/// `weights`: weights of the samples; `noise_m`, `floor_m`: estimated standard deviation of one
/// length, and its lower limit. The noise is estimated again, because errors that these numbers
/// explain are not noise.
StringVector offset_uncertainty_m(const CalibrationModel& model,
                                  const std::vector<StringVector>& paid_out_m, const Bundle& bundle,
                                  const Eigen::VectorXd& weights, double noise_m, double floor_m);

}  // namespace spidar
