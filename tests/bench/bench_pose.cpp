// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Time, in nanoseconds, and error of the pose solver, while tracking encoder counts and from a cold
// start. Geometry and encoder step are those of the SPIDAR-G6X3. Compare
// times within one run only; absolute times depend on the machine.
#include <cmath>
#include <cstdio>
#include <vector>

#include <Eigen/LU>

#include "core/grip/pose_solver.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/support/string_samples.h"

namespace {

using namespace spidar;
using namespace spidar::bench;

constexpr double kCount_m = 1.66555e-5;
constexpr double kDegree = M_PI / 180;

const StringGeometry& geometry() {
  static const StringGeometry g = test::g6x3_geometry();
  return g;
}

StringVector quantised(StringVector lengths) {
  for (double& l : lengths) l = std::round(l / kCount_m) * kCount_m;
  return lengths;
}

/// Peaks of about 1 m/s and 5 rad/s.
Pose moving(double t_s) {
  Pose pose;
  pose.position_m =
      0.03 * Eigen::Vector3d(std::sin(23 * t_s), std::sin(19 * t_s + 1), std::sin(29 * t_s + 2));
  pose.orientation = Eigen::AngleAxisd(std::sin(5 * t_s), Eigen::Vector3d(1, 2, -1).normalized());
  return pose;
}

void track_counts() {
  std::vector<Pose> poses;
  std::vector<StringVector> lengths;
  double floor_m2 = 0, floor_rad2 = 0;
  for (int tick = 0; tick < 4000; ++tick) {
    poses.push_back(moving(tick * 1e-3));
    lengths.push_back(quantised(string_lengths_m(geometry(), poses.back())));
    const StructureMatrix W = structure_matrix(geometry(), poses.back());
    const Eigen::Matrix<double, 6, 6> covariance =
        kCount_m * kCount_m / 12 * (W * W.transpose()).inverse();
    floor_m2 += covariance.topLeftCorner<3, 3>().trace() / 4000;
    floor_rad2 += covariance.bottomRightCorner<3, 3>().trace() / 4000;
  }
  std::printf(
      "tracking encoder counts at 1 kHz, 4000 ticks; quantisation alone: %.2f um, %.3f mrad rms\n",
      1e6 * std::sqrt(floor_m2), 1e3 * std::sqrt(floor_rad2));
  std::printf("%9s %8s %8s | %6s %6s %6s um | %5s %5s %5s mrad\n", "median ns", "99 %", "max",
              "rms", "99 %", "max", "rms", "99 %", "max");
  PoseSolver solver(geometry());
  std::vector<Pose> found(poses.size());
  const CallTimes ns = time_calls(
      poses.size(), 9, [&] { solver.reset(poses[0]); },
      [&](size_t i) { found[i] = solver.solve(lengths[i]).pose; });
  std::vector<double> um, mrad;
  double um2 = 0, mrad2 = 0;
  for (size_t i = 0; i < poses.size(); ++i) {
    um.push_back(1e6 * (found[i].position_m - poses[i].position_m).norm());
    mrad.push_back(1e3 * found[i].orientation.angularDistance(poses[i].orientation));
    um2 += um[i] * um[i] / 4000;
    mrad2 += mrad[i] * mrad[i] / 4000;
  }
  std::printf("%9.0f %8.0f %8.0f | %6.2f %6.1f %6.1f    | %5.3f %5.2f %5.2f\n",
              quantile(ns.median, 0.5), quantile(ns.median, 0.99), quantile(ns.median, 1),
              std::sqrt(um2), quantile(um, 0.99), quantile(um, 1), std::sqrt(mrad2),
              quantile(mrad, 0.99), quantile(mrad, 1));
}

struct Region {
  const char* name;
  Eigen::Vector3d reach_m;
  double least_rad, most_rad;
};

bool is_same(const Pose& a, const Pose& b) {
  return (a.position_m - b.position_m).norm() < 1e-6 &&
         a.orientation.angularDistance(b.orientation) < 1e-4;
}

void cold_start(const Region& region, size_t count) {
  test::Random random(1);
  std::vector<Pose> poses;
  std::vector<StringVector> lengths;
  for (size_t i = 0; i < count; ++i) {
    Pose pose;
    pose.position_m = test::random_vector(random, 1).cwiseProduct(region.reach_m);
    pose.orientation = Eigen::AngleAxisd(test::uniform(random, region.least_rad, region.most_rad),
                                         test::random_direction(random));
    poses.push_back(pose);
    lengths.push_back(string_lengths_m(geometry(), pose));
  }
  std::printf("\ncold start from the centre, %s, %zu poses\n%9s %8s %8s %9s\n", region.name, count,
              "median ns", "99 %", "max", "failures");
  PoseSolver solver(geometry());
  std::vector<Pose> found(count);
  const CallTimes ns = time_calls(
      count, 3, [] {},
      [&](size_t i) {
        solver.reset({});
        found[i] = solver.solve(lengths[i]).pose;
      });
  int failures = 0;
  for (size_t i = 0; i < count; ++i) failures += !is_same(found[i], poses[i]);
  std::printf("%9.0f %8.0f %8.0f %9d\n", quantile(ns.median, 0.5), quantile(ns.median, 0.99),
              quantile(ns.median, 1), failures);
}

}  // namespace

int spidar::bench::pose(int, char**) {
  pin_to_one_core();
  track_counts();
  const Eigen::Vector3d box_m = 0.95 * Eigen::Vector3d(0.06, 0.076, 0.06);
  const Region regions[] = {{"4 cm, 45 deg", Eigen::Vector3d::Constant(0.04), 0, 45 * kDegree},
                            {"95 % of the box, 45 deg", box_m, 0, 45 * kDegree},
                            {"95 % of the box, 60-80 deg", box_m, 60 * kDegree, 80 * kDegree}};
  for (const Region& region : regions) cold_start(region, 1000);
  return 0;
}
