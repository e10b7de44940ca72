// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Compares the pose solver with ceres::TinySolver, in nanoseconds and error, while tracking encoder
// counts and from a cold start. Geometry and encoder step are those of the SPIDAR-G6X3. Compare
// times within one run only; absolute times depend on the machine.
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include <Eigen/LU>
#include <ceres/rotation.h>
#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_autodiff_function.h>

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

/// Length errors over position and a rotation vector on top of `start`, in units of 1 µm so that
/// the absolute tolerances of TinySolver mean something.
struct LengthErrors {
  Eigen::Quaterniond start;
  StringVector lengths_m;

  template <typename T>
  bool operator()(const T* x, T* residuals) const {
    T turn[4], from[4], rotated[4];
    ceres::AngleAxisToQuaternion(x + 3, turn);
    for (int k = 0; k < 4; ++k) from[k] = T(k == 0 ? start.w() : start.coeffs()[k - 1]);
    ceres::QuaternionProduct(turn, from, rotated);
    for (int i = 0; i < kMaxStrings; ++i) {
      const auto n = static_cast<size_t>(i);
      T grip[3], arm[3];
      for (int k = 0; k < 3; ++k) grip[k] = T(geometry().grip_m[n][k]);
      ceres::UnitQuaternionRotatePoint(rotated, grip, arm);
      T square(0);
      for (int k = 0; k < 3; ++k) {
        const T d = T(geometry().exit_m[n][k]) - x[k] - arm[k];
        square += d * d;
      }
      using std::sqrt;
      residuals[i] = (sqrt(square) - T(lengths_m[i])) * T(1e6);
    }
    return true;
  }
};

Pose to_pose(const double* x, const Eigen::Quaterniond& start) {
  Pose pose;
  pose.position_m = Eigen::Vector3d(x[0], x[1], x[2]);
  const Eigen::Vector3d vector(x[3], x[4], x[5]);
  const double angle = vector.norm();
  const Eigen::Quaterniond turn(
      Eigen::AngleAxisd(angle, angle > 0 ? (vector / angle).eval() : Eigen::Vector3d::UnitX()));
  pose.orientation = (turn * start).normalized();
  return pose;
}

class Peer {
 public:
  virtual ~Peer() = default;
  virtual const char* name() const = 0;
  virtual Pose solve(const StringVector& lengths_m) = 0;
  virtual void start(const Pose& pose) = 0;
};

class Ours : public Peer {
 public:
  const char* name() const override { return "ours"; }
  Pose solve(const StringVector& lengths_m) override { return solver_.solve(lengths_m).pose; }
  void start(const Pose& pose) override { solver_.reset(pose); }

 private:
  PoseSolver solver_{geometry()};
};

class Tiny : public Peer {
 public:
  const char* name() const override { return "ceres::TinySolver"; }
  Pose solve(const StringVector& lengths_m) override {
    using Function = ceres::TinySolverAutoDiffFunction<LengthErrors, 8, 6>;
    const LengthErrors errors{last_.orientation, lengths_m};
    Eigen::Matrix<double, 6, 1> x;
    x << last_.position_m, 0, 0, 0;
    ceres::TinySolver<Function> solver;
    solver.Solve(Function(errors), &x);
    return last_ = to_pose(x.data(), last_.orientation);
  }
  void start(const Pose& pose) override { last_ = pose; }

 private:
  Pose last_;
};

using Peers = std::vector<std::unique_ptr<Peer>>;

/// Peaks of about 1 m/s and 5 rad/s.
Pose moving(double t_s) {
  Pose pose;
  pose.position_m =
      0.03 * Eigen::Vector3d(std::sin(23 * t_s), std::sin(19 * t_s + 1), std::sin(29 * t_s + 2));
  pose.orientation = Eigen::AngleAxisd(std::sin(5 * t_s), Eigen::Vector3d(1, 2, -1).normalized());
  return pose;
}

void tracking(const Peers& peers) {
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
  std::printf("%-20s %9s %8s %8s | %6s %6s %6s um | %5s %5s %5s mrad\n", "", "median ns", "99 %",
              "max", "rms", "99 %", "max", "rms", "99 %", "max");
  for (const auto& peer : peers) {
    std::vector<Pose> found(poses.size());
    const CallTimes ns = time_calls(
        poses.size(), 9, [&] { peer->start(poses[0]); },
        [&](size_t i) { found[i] = peer->solve(lengths[i]); });
    std::vector<double> um, mrad;
    double um2 = 0, mrad2 = 0;
    for (size_t i = 0; i < poses.size(); ++i) {
      um.push_back(1e6 * (found[i].position_m - poses[i].position_m).norm());
      mrad.push_back(1e3 * found[i].orientation.angularDistance(poses[i].orientation));
      um2 += um[i] * um[i] / 4000;
      mrad2 += mrad[i] * mrad[i] / 4000;
    }
    std::printf("%-20s %9.0f %8.0f %8.0f | %6.2f %6.1f %6.1f    | %5.3f %5.2f %5.2f\n",
                peer->name(), quantile(ns.median, 0.5), quantile(ns.median, 0.99),
                quantile(ns.median, 1), std::sqrt(um2), quantile(um, 0.99), quantile(um, 1),
                std::sqrt(mrad2), quantile(mrad, 0.99), quantile(mrad, 1));
  }
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

void cold_start(const Region& region, const Peers& peers, size_t count) {
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
  std::printf("\ncold start from the centre, %s, %zu poses\n%-20s %9s %8s %8s %9s\n", region.name,
              count, "", "median ns", "99 %", "max", "failures");
  for (const auto& peer : peers) {
    std::vector<Pose> found(count);
    const CallTimes ns = time_calls(
        count, 3, [] {},
        [&](size_t i) {
          peer->start({});
          found[i] = peer->solve(lengths[i]);
        });
    int failures = 0;
    for (size_t i = 0; i < count; ++i) failures += !is_same(found[i], poses[i]);
    std::printf("%-20s %9.0f %8.0f %8.0f %9d\n", peer->name(), quantile(ns.median, 0.5),
                quantile(ns.median, 0.99), quantile(ns.median, 1), failures);
  }
}

}  // namespace

int spidar::bench::pose(int, char**) {
  pin_to_one_core();
  Peers peers;
  peers.push_back(std::make_unique<Ours>());
  peers.push_back(std::make_unique<Tiny>());
  tracking(peers);
  const Eigen::Vector3d box_m = 0.95 * Eigen::Vector3d(0.06, 0.076, 0.06);
  const Region regions[] = {{"4 cm, 45 deg", Eigen::Vector3d::Constant(0.04), 0, 45 * kDegree},
                            {"95 % of the box, 45 deg", box_m, 0, 45 * kDegree},
                            {"95 % of the box, 60-80 deg", box_m, 60 * kDegree, 80 * kDegree}};
  for (const Region& region : regions) cold_start(region, peers, 1000);
  return 0;
}
