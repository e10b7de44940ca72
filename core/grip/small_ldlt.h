// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A symmetric positive definite system of a few unknowns, picked out of a larger matrix.
#pragma once

#include "core/grip/row.h"

namespace spidar {

/// Solves M y = b, where M consists of the rows and columns `index[0 … N-1]` (ascending) of the 8×8
/// matrix Q, of which only the upper triangle is read, and b = rhs[index]. The diagonal of M is
/// multiplied by 1 + damping. Returns false when rounding has left nothing of a pivot: y is then
/// useless.
///
/// M = LDLᵀ without pivoting, unrolled for N. Eliminating unknown d leaves the Schur complement
///   U(e,a) − U(d,e) U(d,a) / U(d,d),  e, a > d,
/// and row d of Lᵀ is U(d,e) / U(d,d). Forward substitution of b goes along in z.
///
/// Most of the time would go into waiting for one division by a pivot after the other. Two pivots
/// are therefore divided at once: with p = u₀₀, the pivot after it is u₁₁ − u₀₁²/p, whose inverse
/// p / (p u₁₁ − u₀₁²) does not depend on the result of 1/p.
template <int N>
inline bool solve_ldlt(const Row* Q, double damping, const int* index, const double* rhs,
                       double* y) {
  constexpr double kRounding = 0x1p-50;
  double U[N][N];  // row d: of the Schur complement of the first d unknowns, then of D Lᵀ and Lᵀ
  double z[N];     // b, then D⁻¹ L⁻¹ b, then y
#pragma GCC unroll 8
  for (int d = 0; d < N; ++d) {
#pragma GCC unroll 8
    for (int a = d; a < N; ++a) U[d][a] = Q[index[d]][index[a]];
    U[d][d] += damping * U[d][d];
    z[d] = rhs[index[d]];
  }

  const auto eliminate = [&U, &z ](int d, double inverse) __attribute__((always_inline)) {
#pragma GCC unroll 8
    for (int e = d + 1; e < N; ++e) {
      const double m = U[d][e] * inverse;
#pragma GCC unroll 8
      for (int a = e; a < N; ++a) U[e][a] -= m * U[d][a];
      z[e] -= m * z[d];
      U[d][e] = m;
    }
    z[d] *= inverse;
  };
  bool sound = true;
#pragma GCC unroll 8
  for (int d = 0; d < N; d += 2) {
    const double p = U[d][d];
    sound &= p > kRounding * Q[index[d]][index[d]];
    if (d + 1 == N) {
      eliminate(d, 1 / p);
    } else {
      const double determinant = p * U[d + 1][d + 1] - U[d][d + 1] * U[d][d + 1];
      sound &= determinant > kRounding * (p * Q[index[d + 1]][index[d + 1]]);
      const double next = p / determinant;
      eliminate(d, 1 / p);
      eliminate(d + 1, next);
    }
  }

#pragma GCC unroll 8
  for (int d = N - 1; d >= 0; --d) {
#pragma GCC unroll 8
    for (int a = N - 1; a > d; --a) z[d] -= U[d][a] * z[a];
    y[d] = z[d];
  }
  return sound;
}

/// Solves the same for a count that is known only at run time, 0 … 8. Writes y[0 … count-1].
inline bool solve_ldlt(int count, const Row* Q, double damping, const int* index, const double* rhs,
                       double* y) {
  switch (count) {
    case 1:
      return solve_ldlt<1>(Q, damping, index, rhs, y);
    case 2:
      return solve_ldlt<2>(Q, damping, index, rhs, y);
    case 3:
      return solve_ldlt<3>(Q, damping, index, rhs, y);
    case 4:
      return solve_ldlt<4>(Q, damping, index, rhs, y);
    case 5:
      return solve_ldlt<5>(Q, damping, index, rhs, y);
    case 6:
      return solve_ldlt<6>(Q, damping, index, rhs, y);
    case 7:
      return solve_ldlt<7>(Q, damping, index, rhs, y);
    case 8:
      return solve_ldlt<8>(Q, damping, index, rhs, y);
    default:
      return true;
  }
}

}  // namespace spidar
