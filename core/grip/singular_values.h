// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Rank, null space and eigenvectors of matrices whose size is known only at run time. Not for the
/// 1 kHz loop, for it allocates.
#pragma once

#include <Eigen/Core>

namespace spidar {

/// What belongs to the rows of the m×n matrix A = U diag(values) Vᵀ. AᵀA has the eigenvectors V and
/// the eigenvalues values².
struct SingularValues {
  Eigen::VectorXd values;  ///< n, descending, not negative; zeros fill up when m < n
  /// V, n×n and orthogonal. Columns from the rank of A on are a basis of its null space.
  Eigen::MatrixXd directions;
};

/// `A` must not be empty. Compiled here once, because Eigen's decompositions take the compiler up
/// to ten seconds in every file.
SingularValues singular_values(const Eigen::MatrixXd& A);

}  // namespace spidar
