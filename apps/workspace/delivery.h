// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Computes the force that a device delivers for a wanted force.
#pragma once

#include <vector>

#include "core/grip/tension_solver.h"
#include "spidar/profiles/profile.h"

/// The objective that determines the tensions: ½‖S(W t − f)‖² + ½ε‖t − t_ref‖².
struct Weights {
  double epsilon = spidar::TensionProblem().epsilon;                  ///< ε
  double torque_length_m = spidar::TensionProblem().torque_length_m;  ///< ℓ in S
  spidar::StringVector t_ref_N = spidar::StringVector::Zero();
};

/// The weights of the haptic loop: ε as in TensionProblem, ℓ the grip radius if it is not zero, and
/// t_ref the smallest tensions that are allowed.
Weights loop_weights(const spidar::Profile& profile);

/// The default of the published SPIDAR code (Springhead, HISpidarCalc6Dof::SetForce with
/// HISpidarGIf::SetWeight): minimise λt‖Σ tᵢuᵢ − F‖² + λr‖Σ tᵢ(R gᵢ × uᵢ) − T‖² + s‖t‖² with λt =
/// 1, λr = 6, s = 0.3 and the same bounds. Half of it is our objective with 1/ℓ² = λr/λt, that is
/// ℓ = 1/√6 = 0.408 m, ε = s/λt and t_ref = 0.
Weights published_weights();

/// The problem of `profile` with these weights, without pose and wrench.
spidar::TensionProblem tension_problem(const spidar::Profile& profile, const Weights& weights);

/// Result for a wanted force of `kWanted_N` without torque.
struct Delivery {
  double force_N = 0;    ///< component of the delivered force along the wanted one
  double moment_Nm = 0;  ///< size of the delivered torque, which is unwanted
};

inline constexpr double kWanted_N = 3;

/// Directions distributed evenly over the sphere: a Fibonacci lattice.
std::vector<Eigen::Vector3d> even_directions(int count);

/// Solves the problem of `profile` at one pose, for forces in any direction.
class Deliverer {
 public:
  Deliverer(const spidar::Profile& profile, const Weights& weights)
      : problem_(tension_problem(profile, weights)) {}

  void go_to(const spidar::StructureMatrix& W) { problem_.W = W; }

  /// `direction` must have length one. Throws std::runtime_error when no tensions are found.
  Delivery deliver(const Eigen::Vector3d& direction);

  /// Whether the force can be delivered exactly: some t within bounds has W t = f. If so, ½r² ≤
  /// ½ε‖t − t_ref‖² at the minimum, and two points within bounds are at most ‖t_max − t_min‖ apart.
  /// With ε = 1e-12 this gives r ≤ 57 µN for eight strings of 20 N.
  bool delivers_exactly(const Eigen::Vector3d& direction);

 private:
  spidar::TensionResult solve(const Eigen::Vector3d& direction);

  spidar::TensionProblem problem_;
  spidar::TensionSolver solver_;
};
