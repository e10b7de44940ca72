// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Computes tensions for problems on standard input, one on each line:
//   48 numbers of W by rows, 6 of the wrench, 8 t_min, 8 t_max, 8 t_ref, epsilon, l
// where S = diag(1, 1, 1, 1/l, 1/l, 1/l). Writes for each line:
//   8 tensions, status (solved or iteration-limit), relative KKT residual, iterations
// A bad line is reported with its number on standard error and skipped; the exit status is then 1.
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>
#include <vector>

#include "core/grip/tension_solver.h"
#include "line_reader.h"

using namespace spidar;

namespace {

TensionProblem to_problem(const std::vector<double>& numbers) {
  TensionProblem p;
  const double* next = numbers.data();
  for (int row = 0; row < 6; ++row)
    for (int i = 0; i < kMaxStrings; ++i) p.W(row, i) = *next++;
  for (double& f : p.wrench.force_N) f = *next++;
  for (double& f : p.wrench.torque_Nm) f = *next++;
  for (StringVector* v : {&p.t_min_N, &p.t_max_N, &p.t_ref_N})
    for (double& t : *v) t = *next++;
  p.epsilon = *next++;
  p.torque_length_m = *next++;
  return p;
}

std::string solve(const std::vector<double>& numbers) {
  TensionSolver solver;  // without the state of previous lines
  const TensionResult result = solver.solve(to_problem(numbers));
  if (result.status == TensionStatus::kBadInput)
    return "not a problem: all numbers must be finite, t_min <= t_max, epsilon > 0 and l > 0";
  for (double t : result.tension_N) std::printf("%.17g ", t);
  std::printf("%s %.17g %d\n",
              result.status == TensionStatus::kSolved ? "solved" : "iteration-limit",
              result.kkt_residual, result.iterations);
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) {
    const bool help = argc == 2 && std::strcmp(argv[1], "--help") == 0;
    std::fputs("usage: solve_tensions < problems\n", help ? stdout : stderr);
    return help ? 0 : 2;
  }
  return for_each_line(std::cin, 80, solve) > 0;
}
