// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What calibration owes to numbers of the profile that it takes as they are.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "spidar/calibration/bundle_adjustment.h"
#include "spidar/calibration/model.h"

namespace spidar {

/// By how much the profile's numbers may be wrong (standard deviations): what a ruler gives, and
/// the diameter of a drum or the stretch of a string.
inline constexpr double kPointError_m =
    1e-3;                                    ///< of a coordinate of an exit, of a point on the grip
inline constexpr double kScaleError = 5e-3;  ///< of each string's metres_per_count

/// Root mean square errors of the offsets that are to be expected if exits (unless they are
/// estimated), points on the grip and each string's scale are wrong by as much as is said above, a
/// priori, and by what the errors that are left after the fit say of them.
///
/// These numbers join the estimated ones in a linear least squares problem at the fit, with their
/// standard deviations as a prior. Its solution is by how much the offsets are probably off, and
/// its covariance what nothing tells: the sum of squares of both is what is returned. `weights`: of
/// the samples; `noise_m`, `floor_m`: standard deviation of one length as found and as small as it
/// can be. The noise is found anew, for what these numbers explain is not noise.
StringVector offset_uncertainty_m(const CalibrationModel& model,
                                  const std::vector<StringVector>& paid_out_m, const Bundle& bundle,
                                  const Eigen::VectorXd& weights, double noise_m, double floor_m);

}  // namespace spidar
