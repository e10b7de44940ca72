// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <Eigen/Core>

#include "core/grip/string_geometry.h"
#include "core/wrench_size.h"

namespace spidar {

/// Minimise ½‖S(W t − f)‖² + ½ε‖t − t_ref‖² subject to t_min ≤ t ≤ t_max, with S = diag(1, 1, 1,
/// 1/ℓ, 1/ℓ, 1/ℓ). Strictly convex, so there is exactly one solution.
struct TensionProblem {
  int count = kMaxStrings;  ///< used strings, 1 … kMaxStrings; entries beyond are ignored
  StructureMatrix W = StructureMatrix::Zero();
  Wrench wrench;  ///< f
  StringVector t_min_N = StringVector::Zero();
  StringVector t_max_N = StringVector::Zero();
  StringVector t_ref_N = StringVector::Zero();
  double epsilon = 1e-4;                  ///< > 0
  double torque_length_m = kTorqueArm_m;  ///< ℓ > 0
};

enum class TensionStatus {
  kSolved,
  kIterationLimit,  ///< the tensions are within bounds but not optimal
  /// NaN, infinity, or a number whose square is not finite; t_min > t_max; ε or ℓ not positive;
  /// count not 1 … kMaxStrings
  kBadInput,
};

struct TensionResult {
  /// Always within bounds. On bad input: the lower bounds where they are finite, else zero.
  StringVector tension_N = StringVector::Zero();
  Wrench delivered;       ///< W t
  double residual_N = 0;  ///< ‖S(W t − f)‖
  /// The largest violation of the optimality conditions, relative to the largest Qᵢᵢ|tᵢ| + |cᵢ|.
  /// The conditions are Q t = c for free strings, and the sign of Q t − c for strings at a bound,
  /// with Q and c as in TensionObjective in tension_solver.cpp. kSolved means 1e-12 or less.
  double kkt_residual = 0;
  int iterations = 0;  ///< at most 24
  TensionStatus status = TensionStatus::kBadInput;
};

/// Computes string tensions for a wanted wrench, to rounding accuracy at any scale of wrench,
/// tensions and units, even when ε vanishes beside WᵀS²W. Starts from the last solution, so that
/// one iteration is enough in steady motion; the result depends on the start only by rounding. No
/// allocation, no exceptions.
class TensionSolver {
 public:
  TensionResult solve(const TensionProblem& problem) noexcept;

  void reset() noexcept { warm_ = false; }

 private:
  StringVector last_N_ = StringVector::Zero();
  bool warm_ = false;
};

}  // namespace spidar
