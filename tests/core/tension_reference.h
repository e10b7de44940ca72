// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The optimality conditions of the tension problem, in long double. The problem is strictly
/// convex, so that they are met by its solution alone.
#pragma once

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <string>

#include <Eigen/Core>

#include "core/grip/tension_solver.h"

namespace spidar::test {

/// Largest violation of the optimality conditions at `tension`, relative to |Q||t| + |c|.
inline double optimality(const TensionProblem& p, const StringVector& tension) {
  using Long = long double;
  // Of sizes known at run time only: unrolled long double takes the compiler half a minute.
  using Matrix = Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Long, Eigen::Dynamic, 1>;
  // ½ tᵀQt − cᵀt; strings that are not in use have zero rows.
  Vector s(6);
  s << 1, 1, 1, Vector::Constant(3, 1 / Long(p.torque_length_m));
  Matrix A = s.asDiagonal() * Matrix(p.W.cast<Long>());
  for (int i = p.count; i < kMaxStrings; ++i) A.col(i).setZero();
  Matrix Q = A.transpose() * A;
  Vector c = A.transpose() * s.cwiseProduct(Vector(p.wrench.stacked().cast<Long>()));
  for (int i = 0; i < p.count; ++i) {
    Q(i, i) += Long(p.epsilon);
    c[i] += Long(p.epsilon) * Long(p.t_ref_N[i]);
  }
  const Vector t = tension.cast<Long>();
  const Vector g = Q * t - c;
  const Vector size = Q.cwiseAbs() * t.cwiseAbs() + c.cwiseAbs();
  Long worst = 0, scale = 0;
  for (int i = 0; i < p.count; ++i) {
    if (tension[i] > p.t_min_N[i]) worst = std::max(worst, g[i]);
    if (tension[i] < p.t_max_N[i]) worst = std::max(worst, -g[i]);
    scale = std::max(scale, size[i]);
  }
  return scale > 0 ? double(worst / scale) : 0.0;
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
