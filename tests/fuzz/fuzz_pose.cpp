// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Fuzz target of the pose solver; tests/README.md says how to run it under libFuzzer.
// The bytes are read as string lengths of successive ticks, as changes from those at the centre.
// The pose must always be finite and a rotation, and a solved pose must fit the lengths.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/grip/pose_solver.h"
#include "numbers.h"
#include "tests/support/string_samples.h"

using namespace spidar;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  StringGeometry geometry = test::g6x3_geometry();
  geometry.count = 6 + data[0] % 3;
  const double scale_m = data[0] & 64 ? 1e-4 : 0.05;
  PoseSolver solver(geometry);
  StringVector lengths_m = string_lengths_m(geometry, {});
  Numbers numbers(data + 1, size - 1);
  while (!numbers.empty()) {
    for (double& l : lengths_m) l += scale_m * numbers.next();
    const PoseResult result = data[0] & 128 ? solver.locate(lengths_m) : solver.solve(lengths_m);
    require(result.pose.position_m.allFinite(), "fuzz_pose: a position is not finite");
    require(std::abs(result.pose.orientation.norm() - 1) < 1e-12, "fuzz_pose: not a rotation");
    require(result.faulty_string >= -1 && result.faulty_string < geometry.count,
            "fuzz_pose: there is no such string");
    if (result.status != PoseStatus::kSolved) continue;
    require(result.residual_m <= PoseSolver::kMaxResidual_m, "fuzz_pose: solved, but does not fit");
  }
  return 0;
}
