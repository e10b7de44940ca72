// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a device gives of a wanted force.
#pragma once

#include <vector>

#include "core/grip/tension_solver.h"
#include "spidar/profiles/profile.h"

/// What is minimised when tensions are chosen: ½‖S(W t − f)‖² + ½ε‖t − t_ref‖².
struct Weights {
  double epsilon = spidar::TensionProblem().epsilon;                  ///< ε
  double torque_length_m = spidar::TensionProblem().torque_length_m;  ///< ℓ in S
  spidar::StringVector t_ref_N = spidar::StringVector::Zero();
};

/// Those of the haptic loop: ε as in TensionProblem, ℓ the grip radius where there is one, and
/// tensions as low as the strings may be.
Weights loop_weights(const spidar::Profile& profile);

/// The default of the published SPIDAR code (Springhead, HISpidarCalc6Dof::SetForce with
/// HISpidarGIf::SetWeight): minimise λt‖Σ tᵢuᵢ − F‖² + λr‖Σ tᵢ(R gᵢ × uᵢ) − T‖² + s‖t‖² with λt =
/// 1, λr = 6, s = 0.3 and the same bounds. Half of it is our objective with 1/ℓ² = λr/λt, that is
/// ℓ = 1/√6 = 0.408 m, ε = s/λt and t_ref = 0.
Weights published_weights();

/// The problem of `profile` with these weights; pose and wrench are to be filled in.
spidar::TensionProblem tension_problem(const spidar::Profile& profile, const Weights& weights);

/// A wanted force of `kWanted_N` without torque, and what comes.
struct Delivery {
  double force_N = 0;    ///< part of the delivered force that is along the wanted one
  double moment_Nm = 0;  ///< size of the delivered torque: all of it is stray
};

inline constexpr double kWanted_N = 3;

/// Directions spread evenly over the sphere: a Fibonacci lattice.
std::vector<Eigen::Vector3d> even_directions(int count);

/// Solves the problem of `profile` at one pose for a force in any direction.
class Deliverer {
 public:
  Deliverer(const spidar::Profile& profile, const Weights& weights)
      : problem_(tension_problem(profile, weights)) {}

  void go_to(const spidar::StructureMatrix& W) { problem_.W = W; }

  /// `direction` has length one. Throws std::runtime_error when the tensions could not be found.
  Delivery deliver(const Eigen::Vector3d& direction);

  /// Whether the whole force comes, and nothing else: some t within bounds has W t = f. At the
  /// minimum ½r² ≤ ½ε‖t − t_ref‖² if there is one, and the tensions of two points within bounds are
  /// ‖t_max − t_min‖ apart at most. With ε = 1e-12 that leaves r = 57 µN for eight strings of 20 N.
  bool delivers_exactly(const Eigen::Vector3d& direction);

 private:
  spidar::TensionResult solve(const Eigen::Vector3d& direction);

  spidar::TensionProblem problem_;
  spidar::TensionSolver solver_;
};
