// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/tension_step.h"

#include <algorithm>
#include <cmath>

#include "core/grip/singular_values.h"
#include "core/grip/small_ldlt.h"

namespace spidar::test {
namespace {

using StringMatrix = Eigen::Matrix<double, kMaxStrings, kMaxStrings>;

/// ½tᵀQt − cᵀt as in core/grip/tension_solver.h; strings that are not in use have zero rows.
struct Quadratic {
  StringMatrix Q = StringMatrix::Zero();
  StringVector c = StringVector::Zero();

  explicit Quadratic(const TensionProblem& p) {
    Eigen::Matrix<double, 6, 1> s = Eigen::Matrix<double, 6, 1>::Ones();
    s.tail<3>() /= p.torque_length_m;
    StructureMatrix A = s.asDiagonal() * p.W;
    A.rightCols(kMaxStrings - p.count).setZero();
    Q = A.transpose() * A;
    c = A.transpose() * s.cwiseProduct(p.wrench.stacked());
    Q.diagonal().head(p.count).array() += p.epsilon;
    c.head(p.count) += p.epsilon * p.t_ref_N.head(p.count);
  }
};

/// y[0 … count-1] with Q_FF y = g_F, F = index[0 … count-1].
bool solve(const StringMatrix& Q, const StringVector& g, const int* index, int count, double* y) {
  alignas(16) Row Q_rows[kMaxStrings];
  for (int row = 0; row < kMaxStrings; ++row)
    for (int column = 0; column < kMaxStrings; ++column) Q_rows[row][column] = Q(row, column);
  return solve_ldlt(count, Q_rows, 0, index, g.data(), y);
}

}  // namespace

TensionStep tension_step(const TensionProblem& before, const StringVector& t1,
                         const TensionProblem& after, const StringVector& t2) {
  const Quadratic first(before), second(after);
  const StringVector g = (second.c - second.Q * t2) - (first.c - first.Q * t2);
  int moved[kMaxStrings], count = 0;
  TensionStep step;
  for (int i = 0; i < before.count; ++i) {
    if (t1[i] == t2[i]) continue;
    moved[count++] = i;
    step.largest_N = std::max(step.largest_N, std::abs(t2[i] - t1[i]));
  }
  if (count == 0) return step;

  for (unsigned set = 1; set < 1u << count; ++set) {
    int free[kMaxStrings], size = 0;
    for (int a = 0; a < count; ++a)
      if (set >> a & 1u) free[size++] = moved[a];
    double slope[kMaxStrings];
    if (solve(first.Q, g, free, size, slope))
      for (int a = 0; a < size; ++a)
        step.piecewise_N = std::max(step.piecewise_N, std::abs(slope[a]));
  }
  double slope[kMaxStrings], product = 0;
  if (solve(first.Q, g, moved, count, slope))
    for (int a = 0; a < count; ++a) product += g[moved[a]] * slope[a];
  Eigen::MatrixXd Q(count, count);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b) Q(a, b) = first.Q(moved[a], moved[b]);
  step.lipschitz_N = std::sqrt(product / singular_values(Q).values[count - 1]);
  return step;
}

}  // namespace spidar::test
