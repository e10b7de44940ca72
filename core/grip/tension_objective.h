// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The objective of the tension problem, its gradient and its curvature.
#pragma once

#include <Eigen/Core>

#include "core/grip/tension_solver.h"

namespace spidar {

/// ½‖A t − b‖² + ½ε‖t − t_ref‖² with A = S W, b = S f.
struct TensionObjective {
  StructureMatrix A;
  Eigen::Matrix<double, 6, 1> b;
  Eigen::Matrix<double, kMaxStrings, kMaxStrings> Q;  ///< AᵀA + εI
  StringVector c;  ///< Aᵀb + ε t_ref: the gradient is Q t − c
  double epsilon;
  const StringVector& reference;

  /// All eight strings of `p` are used. `p` must outlive the objective.
  explicit TensionObjective(const TensionProblem& p) noexcept
      : A(p.W), b(p.wrench.stacked()), epsilon(p.epsilon), reference(p.t_ref_N) {
    A.bottomRows<3>() *= 1 / p.torque_length_m;
    b.tail<3>() *= 1 / p.torque_length_m;
    Q.noalias() = A.transpose() * A;
    Q.diagonal().array() += epsilon;
    c = epsilon * reference;
    c.noalias() += A.transpose() * b;
  }

  /// False when W, f, t_ref, ε or ℓ were not finite, or so large that their squares are not: all of
  /// them are terms of c and of the diagonal of Q.
  bool is_finite() const noexcept { return Q.diagonal().allFinite() && c.allFinite(); }

  /// False when c is zero: neither a wrench nor t_ref draws the tensions away from zero.
  bool has_pull() const noexcept { return (c.array() != 0).any(); }

  /// residual = A t − b, gradient = Aᵀ residual + ε (t − t_ref).
  void evaluate(const StringVector& t, Eigen::Matrix<double, 6, 1>& residual,
                StringVector& gradient) const noexcept {
    residual = -b;
    residual.noalias() += A * t;
    gradient = epsilon * (t - reference);
    gradient.noalias() += A.transpose() * residual;
  }

  /// Largest Qᵢᵢ|tᵢ| + |cᵢ|: the size of the terms that cancel in the gradient.
  double gradient_scale(const StringVector& t) const noexcept {
    return (Q.diagonal().cwiseProduct(t.cwiseAbs()) + c.cwiseAbs()).maxCoeff();
  }
};

}  // namespace spidar
