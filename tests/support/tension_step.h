/// How far the exact tensions can move between two problems.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "core/grip/tension_solver.h"

namespace spidar::test {

/// Let t₁ and t₂ minimise ½tᵀQ₁t − c₁ᵀt and ½tᵀQ₂t − c₂ᵀt over the same box. Strings that did not
/// move (t₁ᵢ = t₂ᵢ, those that stay at a bound) can be held where they are: t₁ and t₂ still
/// minimise over the others. From here on the vectors are those of the strings that moved.
///
/// g = (c₂ − Q₂t₂) − (c₁ − Q₁t₂) is what changed. Its use is that t₂ also minimises
/// ½tᵀQ₁t − (c₁ + g)ᵀt, because the gradients agree: Q₁t₂ − (c₁ + g) = Q₂t₂ − c₂. So t₁ and t₂
/// solve problems that differ in the linear term alone, and two bounds follow for δ = t₂ − t₁.
///
/// `lipschitz_N`: a minimum over a convex set is where the gradient points along no way that is
/// open: (Q₁t₁ − c₁)ᵀ(t₂ − t₁) ≥ 0 and (Q₁t₂ − c₁ − g)ᵀ(t₁ − t₂) ≥ 0. Their sum is
/// δᵀQ₁δ ≤ gᵀδ ≤ ‖Q₁^−½ g‖ ‖Q₁^½ δ‖, thus ‖Q₁^½ δ‖ ≤ ‖Q₁^−½ g‖ and
/// ‖δ‖ ≤ λmin(Q₁)^−½ ‖Q₁^−½ g‖.
///
/// `piecewise_N`: the minimum for c₁ + s g is a continuous and piecewise linear function of s, with
/// slope Q_FF⁻¹ g_F for the free strings F and 0 for the others (Bemporad et al., The explicit
/// linear quadratic regulator for constrained systems, Automatica 38, 2002). From s = 0 to 1 string
/// i moves at most max over F of |(Q_FF⁻¹ g_F)ᵢ|. All sets F of moved strings are tried, hence no
/// knowledge of which were free. Never above lipschitz_N, and equal to the step when no string
/// meets or leaves a bound and F gives the largest slope.
struct TensionStep {
  double largest_N = 0;    ///< |δᵢ| of the string that moved most
  double piecewise_N = 0;  ///< not below largest_N
  double lipschitz_N = 0;  ///< not below the Euclidean norm of δ
};

namespace detail {

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

inline SomeMatrix restricted(const StringMatrix& Q, const int* index, int count) {
  SomeMatrix M(count, count);
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b) M(a, b) = Q(index[a], index[b]);
  return M;
}

inline SomeStrings restricted(const StringVector& g, const int* index, int count) {
  SomeStrings v(count);
  for (int a = 0; a < count; ++a) v[a] = g[index[a]];
  return v;
}

}  // namespace detail

/// The step from `before` with solution t1 to `after` with solution t2, both with the same strings
/// and bounds.
inline TensionStep tension_step(const TensionProblem& before, const StringVector& t1,
                                const TensionProblem& after, const StringVector& t2) {
  const detail::Quadratic first(before), second(after);
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
    const detail::SomeStrings slope =
        detail::restricted(first.Q, free, size).llt().solve(detail::restricted(g, free, size));
    step.piecewise_N = std::max(step.piecewise_N, slope.lpNorm<Eigen::Infinity>());
  }
  const detail::SomeMatrix Q = detail::restricted(first.Q, moved, count);
  const detail::SomeStrings v = detail::restricted(g, moved, count);
  const Eigen::SelfAdjointEigenSolver<detail::SomeMatrix> eigen(Q, Eigen::EigenvaluesOnly);
  step.lipschitz_N = std::sqrt(v.dot(Q.llt().solve(v)) / eigen.eigenvalues()[0]);
  return step;
}

}  // namespace spidar::test
