// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Bounds how far the exact tensions can change between two problems.
#pragma once

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

/// The step from `before` with solution t1 to `after` with solution t2, both with the same strings
/// and bounds.
TensionStep tension_step(const TensionProblem& before, const StringVector& t1,
                         const TensionProblem& after, const StringVector& t2);

}  // namespace spidar::test
