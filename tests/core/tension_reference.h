// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Solves the tension problem by trying every combination of active bounds, in long double.
#pragma once

#include <algorithm>
#include <array>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>

#include <Eigen/Cholesky>

#include "core/grip/tension_solver.h"

namespace spidar::test {

/// Largest violation of the optimality conditions at `tension`, relative to |Q||t| + |c|, and what
/// |Q||t| + |c| is.
struct Optimality {
  double relative = 0;
  double scale = 0;
};

namespace detail {

using Long = long double;
// Of sizes known at run time only: unrolled long double takes the compiler half a minute.
using LongMatrix = Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<Long, Eigen::Dynamic, 1>;

/// ½ tᵀQt − cᵀt; strings that are not in use have zero rows.
struct Objective {
  LongMatrix Q;
  LongVector c;

  explicit Objective(const TensionProblem& p) {
    LongVector s(6);
    s << 1, 1, 1, LongVector::Constant(3, 1 / Long(p.torque_length_m));
    LongMatrix A = s.asDiagonal() * LongMatrix(p.W.cast<Long>());
    for (int i = p.count; i < kMaxStrings; ++i) A.col(i).setZero();
    const LongVector f = s.cwiseProduct(LongVector(p.wrench.stacked().cast<Long>()));
    Q = A.transpose() * A;
    c = A.transpose() * f;
    for (int i = 0; i < p.count; ++i) {
      Q(i, i) += Long(p.epsilon);
      c[i] += Long(p.epsilon) * Long(p.t_ref_N[i]);
    }
  }

  Long operator()(const LongVector& t) const { return t.dot(Q * t) / 2 - c.dot(t); }
};

/// Minimiser over the strings with `free`, the others held at `t`.
inline LongVector free_minimum(const Objective& objective, const LongVector& t,
                               const std::array<bool, kMaxStrings>& free) {
  LongMatrix A = LongMatrix::Identity(kMaxStrings, kMaxStrings);
  LongVector b = t;
  const LongVector g = objective.c - objective.Q * t;
  for (int i = 0; i < kMaxStrings; ++i) {
    if (!free[i]) continue;
    b[i] = g[i];
    for (int j = 0; j < kMaxStrings; ++j)
      if (free[j]) A(i, j) = objective.Q(i, j);
  }
  return A.llt().solve(b);
}

}  // namespace detail

inline Optimality optimality(const TensionProblem& p, const StringVector& tension) {
  const detail::Objective objective(p);
  const detail::LongVector t = tension.cast<detail::Long>();
  const detail::LongVector g = objective.Q * t - objective.c;
  const detail::LongVector size = objective.Q.cwiseAbs() * t.cwiseAbs() + objective.c.cwiseAbs();
  detail::Long worst = 0, scale = 0;
  for (int i = 0; i < p.count; ++i) {
    if (tension[i] > p.t_min_N[i]) worst = std::max(worst, g[i]);
    if (tension[i] < p.t_max_N[i]) worst = std::max(worst, -g[i]);
    scale = std::max(scale, size[i]);
  }
  return {scale > 0 ? double(worst / scale) : 0.0, double(scale)};
}

/// Of all patterns of strings at t_min, at t_max and free, the feasible one with the least
/// objective.
inline StringVector solve_by_enumeration(const TensionProblem& p) {
  const detail::Objective objective(p);
  int patterns = 1;
  for (int i = 0; i < p.count; ++i) patterns *= 3;
  detail::Long best = std::numeric_limits<detail::Long>::infinity();
  detail::LongVector best_t = detail::LongVector::Zero(kMaxStrings);
  for (int pattern = 0; pattern < patterns; ++pattern) {
    detail::LongVector t = detail::LongVector::Zero(kMaxStrings);
    std::array<bool, kMaxStrings> free{};
    for (int i = 0, rest = pattern; i < p.count; ++i, rest /= 3) {
      free[i] = rest % 3 == 0;
      if (rest % 3 == 1) t[i] = p.t_min_N[i];
      if (rest % 3 == 2) t[i] = p.t_max_N[i];
    }
    t = detail::free_minimum(objective, t, free);
    bool feasible = true;
    for (int i = 0; i < p.count; ++i)
      feasible = feasible && t[i] >= p.t_min_N[i] && t[i] <= p.t_max_N[i];
    const detail::Long value = objective(t);
    if (feasible && value < best) {
      best = value;
      best_t = t;
    }
  }
  return best_t.cast<double>();
}

/// A problem as one line, for messages: W by rows, f, t_min, t_max, t_ref, ε, ℓ.
inline std::string to_line(const TensionProblem& p) {
  std::ostringstream line;
  line << std::setprecision(17);
  for (int row = 0; row < 6; ++row)
    for (int i = 0; i < kMaxStrings; ++i) line << p.W(row, i) << ' ';
  for (double f : p.wrench.stacked()) line << f << ' ';
  for (const StringVector* v : {&p.t_min_N, &p.t_max_N, &p.t_ref_N})
    for (double t : *v) line << t << ' ';
  line << p.epsilon << ' ' << p.torque_length_m;
  return line.str();
}

}  // namespace spidar::test
