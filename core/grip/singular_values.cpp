// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/grip/singular_values.h"

#include <opencv2/core.hpp>

namespace spidar {

SingularValues singular_values(const Eigen::MatrixXd& A) {
  const int m = static_cast<int>(A.rows()), n = static_cast<int>(A.cols());
  // Eigen stores columns, OpenCV rows: what OpenCV reads, and does not change, is Aᵀ = V
  // diag(values) Uᵀ.
  const cv::Mat transposed(n, m, CV_64F, const_cast<double*>(A.data()));
  cv::Mat values, V, Ut;
  // Full matrices only where that completes V and not U, which may have thousands of rows.
  cv::SVD::compute(transposed, values, V, Ut, m < n ? cv::SVD::FULL_UV : 0);
  SingularValues found{Eigen::VectorXd::Zero(n), Eigen::MatrixXd(n, n)};
  for (int k = 0; k < values.rows; ++k) found.values[k] = values.at<double>(k);
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column)
      found.directions(row, column) = V.at<double>(row, column);
  return found;
}

}  // namespace spidar
