// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The objective of the tension problem, its gradient and its curvature.
#pragma once

#include "core/grip/row.h"
#include "core/grip/tension_solver.h"

namespace spidar {

/// ½‖A t − b‖² + ½ε‖t − t_ref‖² with A = S W, b = S f.
struct TensionObjective {
  alignas(16) Row A[6];  ///< S W by rows
  alignas(16) Row Q[8];  ///< AᵀA + εI, upper triangle
  alignas(16) Row c;     ///< Aᵀb + ε t_ref: the gradient is Q t − c
  double b[6];
  double epsilon;
  const double* reference;

  /// All eight strings of `p` are used. `p` must outlive the objective.
  explicit TensionObjective(const TensionProblem& p) noexcept
      : epsilon(p.epsilon), reference(p.t_ref_N.data()) {
    const double to_force = 1 / p.torque_length_m;
    for (int k = 0; k < 3; ++k) {
      b[k] = p.wrench.force_N[k];
      b[k + 3] = p.wrench.torque_Nm[k] * to_force;
    }
    scale_rows(p.W.data(), to_force);
    multiply_right_side();
    multiply_matrix();
  }

  /// False when W, f, t_ref, ε or ℓ were not finite, or so large that their squares are not: all of
  /// them are terms of c and of the diagonal of Q, and zero times infinity or NaN is not zero.
  bool is_finite() const noexcept {
    Pair sum = {};
#pragma GCC unroll 4
    for (int p = 0; p < kPairs; ++p) sum += 0 * diagonal(p) + 0 * pair(c, p);
    return sum[0] + sum[1] == 0;
  }

  /// False when c is zero: neither a wrench nor t_ref draws the tensions away from zero.
  bool has_pull() const noexcept {
    return largest(magnitude(pair(c, 0)), magnitude(pair(c, 1)), magnitude(pair(c, 2)),
                   magnitude(pair(c, 3))) > 0;
  }

  /// residual = A t − b, gradient = Aᵀ residual + ε (t − t_ref).
  void evaluate(const double* t, double* residual, double* gradient) const noexcept {
#pragma GCC unroll 6
    for (int k = 0; k < 6; ++k) {
      const Pair sum = (pair(A[k], 0) * pair(t, 0) + pair(A[k], 1) * pair(t, 1)) +
                       (pair(A[k], 2) * pair(t, 2) + pair(A[k], 3) * pair(t, 3));
      residual[k] = sum[0] + sum[1] - b[k];
    }
#pragma GCC unroll 4
    for (int p = 0; p < kPairs; ++p) {
      Pair force = epsilon * (pair(t, p) - pair(reference, p));
      Pair torque = {};
#pragma GCC unroll 3
      for (int k = 0; k < 3; ++k) {
        force += pair(A[k], p) * residual[k];
        torque += pair(A[k + 3], p) * residual[k + 3];
      }
      pair(gradient, p) = force + torque;
    }
  }

  /// Largest Qᵢᵢ|tᵢ| + |cᵢ|: the size of the terms that cancel in the gradient.
  double gradient_scale(const double* t) const noexcept {
    Pair size[kPairs];
#pragma GCC unroll 4
    for (int p = 0; p < kPairs; ++p)
      size[p] = diagonal(p) * magnitude(pair(t, p)) + magnitude(pair(c, p));
    return largest(size[0], size[1], size[2], size[3]);
  }

 private:
  Pair diagonal(int p) const noexcept {
    return Pair{Q[2 * p][2 * p], Q[2 * p + 1][2 * p + 1]};
  }

  // W is stored by columns of six.
  void scale_rows(const double* W, double to_force) noexcept {
    const Pair scale[3] = {{1, 1}, {1, to_force}, {to_force, to_force}};
#pragma GCC unroll 4
    for (int p = 0; p < kPairs; ++p) {
#pragma GCC unroll 3
      for (int k = 0; k < 3; ++k) {
        const Pair left = scale[k] * pair(W + 12 * p, k);
        const Pair right = scale[k] * pair(W + 12 * p + 6, k);
        pair(A[2 * k], p) = Pair{left[0], right[0]};
        pair(A[2 * k + 1], p) = Pair{left[1], right[1]};
      }
    }
  }

  // c = Aᵀb + ε t_ref, two strings at a time.
  void multiply_right_side() noexcept {
#pragma GCC unroll 4
    for (int p = 0; p < kPairs; ++p) {
      Pair sum = epsilon * pair(reference, p);
#pragma GCC unroll 6
      for (int k = 0; k < 6; ++k) sum += pair(A[k], p) * b[k];
      pair(c, p) = sum;
    }
  }

  // Q = AᵀA + εI as a sum of six outer products, Q(i,·) = Σ_k A(k,i) A(k,·) + ε e_i. Rows 2j and
  // 2j + 1 are made together, from the pair of columns on the diagonal to the right end; this fills
  // one place below the diagonal, Q(2j+1, 2j), which nobody reads.
  void multiply_matrix() noexcept {
#pragma GCC unroll 4
    for (int j = 0; j < kPairs; ++j) {
      Pair even[kPairs] = {}, odd[kPairs] = {};
#pragma GCC unroll 6
      for (int k = 0; k < 6; ++k)
#pragma GCC unroll 4
        for (int p = j; p < kPairs; ++p) {
          even[p] += pair(A[k], p) * A[k][2 * j];
          odd[p] += pair(A[k], p) * A[k][2 * j + 1];
        }
      even[j] += Pair{epsilon, 0};
      odd[j] += Pair{0, epsilon};
#pragma GCC unroll 4
      for (int p = j; p < kPairs; ++p) {
        pair(Q[2 * j], p) = even[p];
        pair(Q[2 * j + 1], p) = odd[p];
      }
    }
  }
};

}  // namespace spidar
