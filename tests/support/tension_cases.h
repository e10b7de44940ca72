// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Families of tension problems, from everyday ones to hard ones.
#pragma once

#include "core/grip/tension_solver.h"
#include "tests/support/string_samples.h"

namespace spidar::test {

enum class TensionCase {
  kNearCentre,     ///< ±2 cm, 20°, forces to 3 N
  kReachable,      ///< ±4 cm, 45°, a wrench that tensions within the bounds deliver exactly
  kFrameEdge,      ///< one coordinate 50 … 75 mm off the centre
  kTurned,         ///< rotated by 60 … 80°
  kBeyondReach,    ///< 10 … 100 times the reach of the strings
  kRankDeficient,  ///< singular values, strings or rows of W that nearly vanish or coincide
  kFixedStrings,   ///< t_min = t_max on some strings
  kDegenerate,     ///< zero multipliers, slack strings, no wrench, symmetric poses
  kScaled,         ///< objective, wrench, tensions or the unit of length times 1e±9
  kTinyEpsilon,    ///< ε down to 1e-12
  kOutsideFrame,   ///< ±30 cm, any rotation
  kFewStrings,     ///< 4 … 8 strings, point grips
};
constexpr int kTensionCases = 12;

const char* name(TensionCase c);

/// The bounds of a SPIDAR-G6X3.
TensionProblem g6x3_problem(const Pose& pose, const Wrench& wrench = {});

TensionProblem random_problem(Random& random, TensionCase c);

}  // namespace spidar::test
