// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/tension_cases.h"

#include <cmath>

#include "core/grip/matrices.h"

namespace spidar::test {
namespace {

Wrench wrench_of(const TensionProblem& p, const StringVector& tension_N) {
  const Eigen::Matrix<double, 6, 1> w = p.W * tension_N;
  return {w.head<3>(), w.tail<3>()};
}

double power_of_ten(Random& random, double low, double high) {
  return std::pow(10.0, uniform(random, low, high));
}

int pick(Random& random, int count) {
  return static_cast<int>(random() % static_cast<unsigned>(count));
}

StringVector random_tensions(Random& random, double low_N, double high_N) {
  StringVector t;
  for (double& x : t) x = uniform(random, low_N, high_N);
  return t;
}

TensionProblem any_of_the_first(Random& random, int count) {
  return random_problem(random, static_cast<TensionCase>(pick(random, count)));
}

TensionProblem rank_deficient(Random& random) {
  TensionProblem p = any_of_the_first(random, 4);
  switch (pick(random, 3)) {
    case 0: {
      // W V = U diag(values)
      const Eigen::MatrixXd V = singular_values(p.W).directions;
      StructureMatrix scaled = p.W * V;
      for (int i = 5 - pick(random, 3); i < 6; ++i) scaled.col(i) *= power_of_ten(random, -15, -4);
      p.W = scaled * V.transpose();
      break;
    }
    case 1:
      p.W.col(pick(random, 8)) = (1 + power_of_ten(random, -17, -6)) * p.W.col(pick(random, 8));
      break;
    default:
      p.W.row(pick(random, 6)) *= power_of_ten(random, -14, -3);
  }
  return p;
}

TensionProblem degenerate(Random& random) {
  TensionProblem p = any_of_the_first(random, 5);
  StringVector t = random_tensions(random, 0.3, 5);
  for (int i = 0; i < 8; ++i) {
    if (pick(random, 4) == 0) t[i] = p.t_min_N[i];
    if (pick(random, 4) == 0) t[i] = p.t_max_N[i];
  }
  switch (pick(random, 5)) {
    case 0:  // the solution is t_ref, partly on the bounds, and every multiplier is zero
      p.wrench = wrench_of(p, t);
      p.t_ref_N = t;
      break;
    case 1:
      for (int i = 0; i < 8; ++i)
        if (pick(random, 3) == 0) p.W.col(i).setZero();
      break;
    case 2:
      p.wrench = {};
      p.t_min_N.setZero();
      p.t_ref_N.setZero();
      break;
    case 3:
      p.wrench = wrench_of(p, t);
      p.t_ref_N = p.t_min_N;
      break;
    default:
      p = g6x3_problem(Pose());
      p.wrench.force_N[pick(random, 3)] = 5.0 * (pick(random, 9) - 4);
      p.t_ref_N = pick(random, 2) ? p.t_min_N : p.t_max_N;
  }
  return p;
}

TensionProblem scaled(Random& random) {
  TensionProblem p = any_of_the_first(random, 8);
  const double s = pick(random, 2) ? 1e9 : 1e-9;
  switch (pick(random, 4)) {
    case 0:
      p.W *= std::sqrt(s);
      p.wrench = std::sqrt(s) * p.wrench;
      p.epsilon *= s;
      break;
    case 1:
      p.wrench = s * p.wrench;
      break;
    case 2:
      p.wrench = s * p.wrench;
      p.t_min_N *= s;
      p.t_max_N *= s;
      p.t_ref_N *= s;
      break;
    default:
      p.W.bottomRows<3>() *= s;
      p.wrench.torque_Nm *= s;
      p.torque_length_m *= s;
  }
  return p;
}

}  // namespace

const char* name(TensionCase c) {
  constexpr const char* kNames[kTensionCases] = {
      "near the centre", "reachable",      "edge of the frame", "turned 60-80 deg",
      "beyond reach",    "rank deficient", "fixed strings",     "degenerate",
      "scaled 1e+-9",    "tiny epsilon",   "outside the frame", "few strings"};
  return kNames[static_cast<int>(c)];
}

TensionProblem g6x3_problem(const Pose& pose, const Wrench& wrench) {
  TensionProblem p;
  p.W = structure_matrix(g6x3_geometry(), pose);
  p.wrench = wrench;
  p.t_min_N.setConstant(0.3);
  p.t_max_N.setConstant(20);
  p.t_ref_N.setConstant(1);
  return p;
}

TensionProblem random_problem(Random& random, TensionCase c) {
  switch (c) {
    case TensionCase::kNearCentre:
      return g6x3_problem(random_pose(random, 0.02, 0.35),
                          {uniform(random, 0, 3) * random_direction(random),
                           uniform(random, 0, 0.03) * random_direction(random)});
    case TensionCase::kReachable: {
      TensionProblem p = g6x3_problem(random_pose(random, 0.04, M_PI / 4));
      p.wrench = wrench_of(p, random_tensions(random, 0.3, 8));
      return p;
    }
    case TensionCase::kFrameEdge: {
      Pose pose = random_pose(random, 0.02, 0.5);
      pose.position_m[pick(random, 3)] = (pick(random, 2) ? 1 : -1) * uniform(random, 0.05, 0.075);
      return g6x3_problem(pose, {random_vector(random, 3), random_vector(random, 0.05)});
    }
    case TensionCase::kTurned: {
      Pose pose = random_pose(random, 0.03, 0);
      pose.orientation =
          Eigen::AngleAxisd(uniform(random, M_PI / 3, M_PI * 80 / 180), random_direction(random));
      return g6x3_problem(pose, {random_vector(random, 3), random_vector(random, 0.05)});
    }
    case TensionCase::kBeyondReach: {
      const double s = power_of_ten(random, 1, 2);
      return g6x3_problem(random_pose(random, 0.04, 1.4),
                          {20 * s * random_direction(random), 0.4 * s * random_direction(random)});
    }
    case TensionCase::kRankDeficient:
      return rank_deficient(random);
    case TensionCase::kFixedStrings: {
      TensionProblem p = any_of_the_first(random, 5);
      for (int k = pick(random, 8); k >= 0; --k) {
        const int i = pick(random, 8);
        p.t_min_N[i] = p.t_max_N[i] = uniform(random, 0.3, 5);
      }
      return p;
    }
    case TensionCase::kDegenerate:
      return degenerate(random);
    case TensionCase::kScaled:
      return scaled(random);
    case TensionCase::kTinyEpsilon: {
      TensionProblem p = any_of_the_first(random, 8);
      p.epsilon = power_of_ten(random, -12, -4);
      return p;
    }
    case TensionCase::kOutsideFrame:
      return g6x3_problem(random_pose(random, 0.3, M_PI),
                          {random_vector(random, 10), random_vector(random, 0.2)});
    case TensionCase::kFewStrings: {
      TensionProblem p = any_of_the_first(random, 9);
      p.count = 4 + pick(random, 5);
      if (pick(random, 2)) p.W.bottomRows<3>().setZero();
      return p;
    }
  }
  return {};
}

}  // namespace spidar::test
