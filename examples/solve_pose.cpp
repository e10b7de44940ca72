// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Computes the grip's pose from string lengths on standard input, eight on each line, in metres:
//   solve_pose PROFILE [--track]
// PROFILE is a name (spidar-gcc, …) or the path of a profile file. Writes for each line:
//   position x y z (m), quaternion w x y z, root mean square length error (m), status
// where status is solved, solved-without-N (string N does not fit the others and was left out),
// ambiguous (the lengths fit two poses within the encoder's step) or not-converged; in the last two
// cases the pose is the previous one. Each line is located starting at the centre, or with --track
// next to the previous line. A bad line is reported with its number on standard error and skipped;
// the exit status is then 1.
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "core/grip/pose_solver.h"
#include "line_reader.h"
#include "spidar/profiles/profile.h"

using namespace spidar;

namespace {

std::string status(const PoseResult& result) {
  if (result.status == PoseStatus::kAmbiguous) return "ambiguous";
  if (result.status != PoseStatus::kSolved) return "not-converged";
  if (result.faulty_string < 0) return "solved";
  return "solved-without-" + std::to_string(result.faulty_string);
}

int run(const char* profile, bool track) {
  const Profile device = load_profile(profile);
  PoseSolver solver(device.geometry, device.max_pose_residual_m());
  const auto solve = [&](const std::vector<double>& numbers) -> std::string {
    if (!track) solver.reset();
    const PoseResult r =
        solver.solve(Eigen::Map<const StringVector, Eigen::Unaligned>(numbers.data()));
    if (r.status == PoseStatus::kBadInput) return "lengths must be finite and not negative";
    for (double x : r.pose.position_m) std::printf("%.17g ", x);
    const Eigen::Quaterniond& q = r.pose.orientation;
    std::printf("%.17g %.17g %.17g %.17g %.17g %s\n", q.w(), q.x(), q.y(), q.z(), r.residual_m,
                status(r).c_str());
    return {};
  };
  return for_each_line(std::cin, kMaxStrings, solve) > 0;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* kUsage = "usage: solve_pose PROFILE [--track] < lengths\n";
  if (argc == 2 && std::strcmp(argv[1], "--help") == 0) return std::fputs(kUsage, stdout) < 0;
  const bool track = argc == 3 && std::strcmp(argv[2], "--track") == 0;
  if ((argc != 2 && !track) || argv[1][0] == '-') {
    std::fputs(kUsage, stderr);
    return 2;
  }
  try {
    return run(argv[1], track);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "solve_pose: %s\n", error.what());
    return 2;
  }
}
