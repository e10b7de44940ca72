// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Linear algebra that Eigen lacks in the form needed here.
#pragma once

#include <Eigen/Core>

namespace spidar {

/// The singular values and the directions V of the m×n matrix A = U diag(values) Vᵀ. AᵀA has the
/// eigenvectors V and the eigenvalues values².
struct SingularValues {
  Eigen::VectorXd values;  ///< n, descending, not negative; padded with zeros if m < n
  /// V, n×n and orthogonal. Columns from the rank of A on are a basis of its null space.
  Eigen::MatrixXd directions;
};

/// Computes the SVD of a non-empty matrix whose size is known only at run time, for its rank, null
/// space and eigenvectors. Not for the 1 kHz loop, because it allocates. By OpenCV, because Eigen's
/// decomposition takes the compiler ten seconds.
SingularValues singular_values(const Eigen::MatrixXd& A);

/// Solves a symmetric positive definite system M y = b of a few unknowns in the 1 kHz loop. M
/// consists of the `count` ≤ 8 rows and columns `index` (ascending) of Q, and b = rhs[index]. Reads
/// only the upper triangle of Q. The diagonal of M is multiplied by 1 + damping. M = LDLᵀ without
/// pivoting. Returns false when rounding has cancelled a pivot; y is then invalid.
template <int kSize>
bool solve_ldlt(int count, const Eigen::Matrix<double, kSize, kSize>& Q, double damping,
                const int* index, const double* rhs, double* y) noexcept {
  constexpr double kRounding = 0x1p-50;
  double U[kSize][kSize];  // row d: of the Schur complement of the first d unknowns, then of Lᵀ
  for (int d = 0; d < count; ++d) {
    for (int a = d; a < count; ++a) U[d][a] = Q(index[d], index[a]);
    U[d][d] += damping * U[d][d];
    y[d] = rhs[index[d]];
  }
  bool sound = true;
  for (int d = 0; d < count; ++d) {
    sound &= U[d][d] > kRounding * Q(index[d], index[d]);
    const double inverse = 1 / U[d][d];
    for (int e = d + 1; e < count; ++e) {
      const double m = U[d][e] * inverse;
      for (int a = e; a < count; ++a) U[e][a] -= m * U[d][a];
      y[e] -= m * y[d];
      U[d][e] = m;
    }
    y[d] *= inverse;
  }
  for (int d = count - 1; d >= 0; --d) {
    for (int a = d + 1; a < count; ++a) y[d] -= U[d][a] * y[a];
  }
  return sound;
}

}  // namespace spidar
