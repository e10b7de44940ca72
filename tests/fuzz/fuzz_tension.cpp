// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Fuzz target of the tension solver; tests/README.md says how to run it under libFuzzer.
// The bytes are read as the numbers of a problem. Tensions must be within valid bounds and never
// NaN, and a solution must be optimal.
#include <cstddef>
#include <cstdint>

#include "core/grip/tension_solver.h"
#include "numbers.h"

using namespace spidar;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  TensionProblem p;
  p.count = data[0] % 11 - 1;
  Numbers numbers(data + 1, size - 1);
  for (int row = 0; row < 6; ++row)
    for (int i = 0; i < kMaxStrings; ++i) p.W(row, i) = numbers.next();
  for (double& f : p.wrench.force_N) f = numbers.next();
  for (double& f : p.wrench.torque_Nm) f = numbers.next();
  for (double& t : p.t_min_N) t = numbers.next();
  for (double& t : p.t_max_N) t = numbers.next();
  for (double& t : p.t_ref_N) t = numbers.next();
  p.epsilon = numbers.next();
  p.torque_length_m = numbers.next();

  static TensionSolver solver;
  const TensionResult result = solver.solve(p);
  require(result.tension_N.allFinite(), "a tension is not finite");
  require(result.iterations <= 24, "more than 24 rounds");
  if (result.status == TensionStatus::kBadInput) return 0;
  for (int i = 0; i < p.count; ++i)
    require(result.tension_N[i] >= p.t_min_N[i] && result.tension_N[i] <= p.t_max_N[i],
            "a tension is out of bounds");
  if (result.status == TensionStatus::kSolved)
    require(result.kkt_residual <= 1e-12, "called solved, but is not");
  return 0;
}
