// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Figures on fixed problems, as `name value`:
//
// - tension_rounds: mean rounds of the tension solver on hard problems, 1000 where one is wrong
// - pose_iterations: mean linearised problems of a cold start 60 to 80° from the pose, 1000 where
//   one is wrong
// - depth_false_percent: pictures of scenes with depth, and of patterns, in which something is felt
//   though only the camera moves
// - cost_ratio: processor time of motion=object over that of DIS on the same frames
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <vector>

#include <opencv2/core/utility.hpp>

#include "core/analysis/motion_analyzer.h"
#include "core/grip/pose_solver.h"
#include "core/grip/tension_solver.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/bench/film_frames.h"
#include "tests/bench/opencv_flow.h"
#include "tests/core/tension_reference.h"
#include "tests/support/depth_clip_score.h"
#include "tests/support/string_samples.h"
#include "tests/support/tension_cases.h"

namespace {

using namespace spidar;
using namespace spidar::bench;

constexpr double kWrong = 1000;

double tension_rounds() {
  constexpr int kOfAFamily = 500;
  constexpr double kRight = 1e-9;  // relative KKT residual, as in bench_tension
  TensionSolver solver;
  double rounds = 0;
  for (int c = 0; c < test::kTensionCases; ++c) {
    test::Random random(2);
    for (int i = 0; i < kOfAFamily; ++i) {
      const TensionProblem p = test::random_problem(random, static_cast<test::TensionCase>(c));
      solver.reset();
      const TensionResult result = solver.solve(p);
      const bool right = test::optimality(p, result.tension_N) <= kRight;
      rounds += right ? result.iterations : kWrong;
    }
  }
  return rounds / (kOfAFamily * test::kTensionCases);
}

double pose_iterations() {
  constexpr int kPoses = 1000;
  const StringGeometry geometry = test::g6x3_geometry();
  test::Random random(1);
  double iterations = 0;
  for (int i = 0; i < kPoses; ++i) {
    Pose pose;
    pose.position_m =
        test::random_vector(random, 1).cwiseProduct(Eigen::Vector3d(0.057, 0.072, 0.057));
    pose.orientation = Eigen::AngleAxisd(test::uniform(random, M_PI / 3, M_PI / 2.25),
                                         test::random_direction(random));
    PoseSolver solver(geometry);
    const PoseResult found = solver.solve(string_lengths_m(geometry, pose));
    const bool right = (found.pose.position_m - pose.position_m).norm() < 1e-6 &&
                       found.pose.orientation.angularDistance(pose.orientation) < 1e-4;
    iterations += right ? found.iterations : kWrong;
  }
  return iterations / kPoses;
}

double depth_false_percent() {
  test::DepthClipScore sum;
  for (int kind = 0; kind < test::DepthClip::kKinds; ++kind) {
    sum += test::score(static_cast<test::DepthClip::Kind>(kind), test::kDepthClips);
  }
  return 100.0 * sum.felt / sum.pictures;
}

double thread_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double cost_ratio() {
  constexpr int kPasses = 15;
  const std::vector<test::Picture> frames = pan_with_object(1280, 720);
  MotionAnalyzer analyzer{AnalyzerSettings()};
  const auto dis = make_dis_ultrafast();
  // Of each frame, the least of all passes: what disturbs only adds.
  std::vector<double> ours_ms(frames.size(), INFINITY), dis_ms = ours_ms;
  int64_t now_ns = 0;
  for (int pass = 0; pass < kPasses; ++pass) {  // in turn, so that what disturbs hits both
    for (size_t i = 0; i < frames.size(); ++i) {
      now_ns += 40'000'000;
      const double begin_ms = thread_ms();
      analyzer.analyze(frames[i].view(), now_ns);
      const double middle_ms = thread_ms();
      dis->find(frames[i].view());
      ours_ms[i] = std::min(ours_ms[i], middle_ms - begin_ms);
      dis_ms[i] = std::min(dis_ms[i], thread_ms() - middle_ms);
    }
  }
  return quantile(ours_ms, 0.5) / quantile(dis_ms, 0.5);
}

}  // namespace

int spidar::bench::regression(int, char**) {
  cv::setNumThreads(1);
  pin_to_one_core();
  std::printf("tension_rounds %.4g\n", tension_rounds());
  std::printf("pose_iterations %.4g\n", pose_iterations());
  std::printf("depth_false_percent %.3g\n", depth_false_percent());
  std::printf("cost_ratio %.3g\n", cost_ratio());
  return 0;
}
