// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/tension_step.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace spidar::test {
namespace {

using StringMatrix = Eigen::Matrix<double, kMaxStrings, kMaxStrings>;
using SomeStrings = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStrings, 1>;
using SomeMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStrings, kMaxStrings>;

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

SomeMatrix restricted(const StringMatrix& Q, const int* index, int count) {
  SomeMatrix M(count, count);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b) M(a, b) = Q(index[a], index[b]);
  return M;
}

SomeStrings restricted(const StringVector& g, const int* index, int count) {
  SomeStrings v(count);
  for (int a = 0; a < count; ++a) v[a] = g[index[a]];
  return v;
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
    const SomeStrings slope =
        restricted(first.Q, free, size).llt().solve(restricted(g, free, size));
    step.piecewise_N = std::max(step.piecewise_N, slope.lpNorm<Eigen::Infinity>());
  }
  const SomeMatrix Q = restricted(first.Q, moved, count);
  const SomeStrings v = restricted(g, moved, count);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Q, Eigen::EigenvaluesOnly);
  step.lipschitz_N = std::sqrt(v.dot(Q.llt().solve(v)) / eigen.eigenvalues()[0]);
  return step;
}

}  // namespace spidar::test
