// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/grip/matrices.h"

#include <Eigen/SVD>

namespace spidar {

SingularValues singular_values(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeFullV);
  SingularValues found{Eigen::VectorXd::Zero(A.cols()), svd.matrixV()};
  found.values.head(svd.singularValues().size()) = svd.singularValues();
  return found;
}

}  // namespace spidar
