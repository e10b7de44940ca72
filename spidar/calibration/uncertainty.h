// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// How well the samples determine what is calibrated: noise, observability, and errors of what is
/// not.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "spidar/calibration/bundle_adjustment.h"
#include "spidar/calibration/model.h"

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

/// Collects linearised samples: errors that depend on the pose of the sample and on shared
/// parameters. The pose is eliminated by an orthogonal projection, which is the Schur complement of
/// bundle adjustment as a square root: it stays accurate, and exact zeros stay zeros, where the
/// information matrix is singular and its inverse does not exist.
class Observability {
 public:
  explicit Observability(int parameters);

  /// Adds one sample with its weight (of squares): derivatives of n errors by the pose's six
  /// directions and by the parameters.
  void add(const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 6>>& by_pose,
           const Eigen::Ref<const Eigen::MatrixXd>& by_parameter, double weight);

  struct Directions {
    /// Standard deviation along each direction for errors of standard deviation one; infinite where
    /// there is no information. Descending.
    Eigen::VectorXd sd;
    Eigen::MatrixXd directions;  ///< orthonormal columns
  };
  Directions directions() const;

 private:
  const int parameters_;
  std::vector<Eigen::VectorXd> rows_;  ///< R by rows: RᵀR is the information
};

/// Standard deviations of the rows of `quantities`, linear in the parameters. Infinite if a
/// direction without information contributes.
Eigen::VectorXd standard_deviations(const Observability::Directions& directions,
                                    const Eigen::MatrixXd& quantities);

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
