// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/grip/matrices.h"

#include <opencv2/core.hpp>

namespace spidar {

SingularValues singular_values(const Eigen::MatrixXd& A) {
  const int rows = static_cast<int>(A.rows()), columns = static_cast<int>(A.cols());
  // Eigen stores column after column, OpenCV row after row: this is Aᵀ = V diag(values) Uᵀ.
  const cv::Mat transposed(columns, rows, CV_64F, const_cast<double*>(A.data()));
  cv::Mat_<double> values, V, U;
  cv::SVD::compute(transposed, values, V, U, rows < columns ? cv::SVD::FULL_UV : 0);
  SingularValues found{Eigen::VectorXd::Zero(columns), Eigen::MatrixXd(columns, columns)};
  for (int k = 0; k < values.rows; ++k) found.values[k] = values(k);
  for (int row = 0; row < columns; ++row) {
    for (int k = 0; k < columns; ++k) found.directions(row, k) = V(row, k);
  }
  return found;
}

}  // namespace spidar
