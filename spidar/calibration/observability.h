// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Determines which shared parameters the samples determine, and which they do not.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace spidar {

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

}  // namespace spidar
