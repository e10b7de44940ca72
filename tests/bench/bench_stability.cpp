// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Numerical stability on hard cases; that of the tension solver is `spidar-bench tension`.
///
/// Fits of models: points that are badly placed, and weights far apart. The reference of the linear
/// models solves the same least squares by QR in long double; for the homography it is the model
/// that moved the points. κ is the condition number of the design (median), *answered* how often
/// there is a model, *error* the largest difference of a displacement, px, in the answers, and
/// *not finite* counts them.
///
/// Pictures: of 16 x 16 px to 8K, 8 and 16 bits, with nothing in them or one pixel. *moves* counts
/// frames in which something is felt, where nothing moves.
///
/// Poses: by the condition number of the structure matrix there, from 1 mm and 0.02 rad away; and
/// of the solved ones, the force along a wanted 3 N (median), and by how much it differs from that
/// at the right pose.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "core/analysis/motion_analyzer.h"
#include "core/grip/pose_solver.h"
#include "core/grip/tension_solver.h"
#include "core/motion/camera/motion_models.h"
#include "spidar/profiles/profile.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/support/random_motion.h"

namespace {

using namespace spidar;
using Eigen::Vector2d;
using Eigen::Vector3d;
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

constexpr int kCases = 2000;
constexpr size_t kPoints = 60;

// --- fits of models

struct Placement {
  const char* name;
  std::function<Vector2d(test::RandomMotion&)> at_px;
  double weights = 1;  ///< largest by smallest
};

Vector2d in_box(test::RandomMotion& random, double width_px, double height_px) {
  return {random.uniform(-width_px, width_px) / 2, random.uniform(-height_px, height_px) / 2};
}

Placement strip(const char* name, double width_px) {
  return {name, [width_px](test::RandomMotion& random) {
            return Vector2d(Eigen::Rotation2Dd(0.5) * in_box(random, 400, width_px));
          }};
}

/// At the corner of a picture of 427 x 240 px.
Vector2d at_corner(test::RandomMotion& random, double size_px) {
  const Vector2d at_px = in_box(random, size_px, size_px);
  return {213 + at_px.x(), 120 + at_px.y()};
}

std::vector<Placement> placements() {
  return {{"all over the picture", [](auto& random) { return in_box(random, 427, 240); }},
          strip("in a strip of 1 px", 1),
          strip("in a strip of 1e-3 px", 1e-3),
          strip("in a strip of 1e-6 px", 1e-6),
          strip("on a line", 0),
          {"within 1 px at a corner", [](auto& random) { return at_corner(random, 1); }},
          {"within 1e-3 px at a corner", [](auto& random) { return at_corner(random, 1e-3); }},
          {"in one position", [](auto&) { return Vector2d(100, 50); }},
          {"weights from 1 to 1e12", [](auto& random) { return in_box(random, 427, 240); }, 1e12},
          {"8K, all over the picture", [](auto& random) { return in_box(random, 7680, 4320); }}};
}

/// Rows of both coordinates of each point, with their weights; columns are shift and linear.
LongMatrix design(ModelKind kind, const std::vector<Displacement>& points,
                  const std::vector<double>& weights) {
  LongMatrix rows = LongMatrix::Zero(static_cast<Eigen::Index>(2 * points.size()),
                                     parameters(std::min(kind, ModelKind::kAffine)));
  for (size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    const long double x = points[i].at_px.x(), y = points[i].at_px.y();
    rows(row, 0) = rows(row + 1, 1) = 1;
    if (kind == ModelKind::kSimilarity) {
      rows.block<2, 2>(row, 2) << x, -y, y, x;
    } else if (kind >= ModelKind::kAffine) {
      rows.block<1, 2>(row, 2) << x, y;
      rows.block<1, 2>(row + 1, 4) << x, y;
    }
    rows.middleRows<2>(row) *= std::sqrt(static_cast<long double>(weights[i]));
  }
  return rows;
}

/// Displacements of the points by the reference, px.
std::vector<Vector2d> reference(ModelKind kind, const MotionModel& truth,
                                const std::vector<Displacement>& points,
                                const std::vector<double>& weights, const LongMatrix& rows) {
  std::vector<Vector2d> moved_px;
  if (kind == ModelKind::kHomography) {
    for (const Displacement& point : points) moved_px.push_back(truth.displacement_px(point.at_px));
    return moved_px;
  }
  LongVector moved(rows.rows());
  for (size_t i = 0; i < points.size(); ++i) {
    const long double root = std::sqrt(static_cast<long double>(weights[i]));
    moved.segment<2>(static_cast<Eigen::Index>(2 * i)) =
        root * points[i].moved_px.cast<long double>();
  }
  const LongVector fitted = rows * rows.colPivHouseholderQr().solve(moved);
  for (size_t i = 0; i < points.size(); ++i) {
    const long double root = std::sqrt(static_cast<long double>(weights[i]));
    moved_px.push_back((fitted.segment<2>(static_cast<Eigen::Index>(2 * i)) / root).cast<double>());
  }
  return moved_px;
}

/// Least squares: no error comes near the reach, so that the weights stay as they are. Of a
/// homography, each fit is then one Gauss–Newton step.
std::optional<MotionModel> least_squares(ModelKind kind, const std::vector<Displacement>& points,
                                         const std::vector<double>& weights) {
  constexpr int kSteps = 5;
  constexpr double kReach_px = 1e7;
  std::optional<MotionModel> model = MotionModel();
  for (int step = 0; step < kSteps && model; ++step) {
    model = fit_robustly(kind, *model, {points, weights, kReach_px});
  }
  return model;
}

void print_fits(ModelKind kind, const Placement& placement) {
  test::RandomMotion random(7);
  std::vector<double> conditions;
  int answered = 0, not_finite = 0;
  double worst_px = 0;
  for (int n = 0; n < kCases; ++n) {
    MotionModel truth;
    truth.kind = kind;
    truth.shift_px = in_box(random, 8, 8);
    if (kind >= ModelKind::kSimilarity) truth.linear = Eigen::Matrix2d::Identity() * 0.01;
    if (kind == ModelKind::kHomography) truth.perspective_1_px = {1e-5, -2e-5};
    std::vector<Displacement> points;
    std::vector<double> weights;
    for (size_t i = 0; i < kPoints; ++i) {
      const Vector2d at_px = placement.at_px(random);
      // Noise-free for the homography, whose reference is the truth.
      const Vector2d noise_px =
          kind == ModelKind::kHomography ? Vector2d(0, 0) : in_box(random, 0.2, 0.2);
      points.push_back({at_px, truth.displacement_px(at_px) + noise_px});
      weights.push_back(std::pow(placement.weights, random.uniform(0, 1)));
    }
    const LongMatrix rows = design(kind, points, weights);
    if (n < 50) {
      const auto values = rows.cast<double>().eval().jacobiSvd().singularValues();
      conditions.push_back(values[0] / std::max(values[values.size() - 1], 1e-300));
    }
    const auto found = least_squares(kind, points, weights);
    if (!found) continue;
    ++answered;
    const std::vector<Vector2d> expected_px = reference(kind, truth, points, weights, rows);
    for (size_t i = 0; i < points.size(); ++i) {
      const double error_px = (found->displacement_px(points[i].at_px) - expected_px[i]).norm();
      not_finite += !std::isfinite(error_px);
      worst_px = std::max(worst_px, error_px);
    }
  }
  std::nth_element(conditions.begin(), conditions.begin() + 25, conditions.end());
  std::printf("| %s | %s | %.0e | %.1f %% | %.1e | %d |\n", to_string(kind), placement.name,
              conditions[25], 100.0 * answered / kCases, worst_px, not_finite);
}

// --- pictures

void print_pictures() {
  struct Content {
    const char* name;
    std::function<int(int x, int y, int frame)> grey;  // 0 … 1 of 255
  };
  const Content contents[] = {
      {"black", [](int, int, int) { return 0; }},
      {"white", [](int, int, int) { return 255; }},
      {"one pixel that rests", [](int x, int y, int) { return x == 9 && y == 7 ? 255 : 0; }},
      {"one pixel that flickers",
       [](int x, int y, int n) { return x == 9 && y == 7 && n % 2 ? 255 : 0; }},
      {"upright stripes along which it moves",
       [](int x, int, int) { return x / 3 % 2 ? 200 : 50; }},
      {"noise of one grey level",
       [](int x, int y, int n) { return 128 + (x * 7919 + y * 104729 + n * 1299709) / 64 % 2; }}};
  std::printf(
      "\n| picture that shows no motion | frames | moves | not finite |\n|---|---|---|---|\n");
  for (const Content& content : contents) {
    int frames = 0, moves = 0, not_finite = 0;
    for (const auto& [width, height] :
         {std::pair(16, 16), {17, 4321}, {4320, 17}, {640, 360}, {7680, 4320}}) {
      for (const int bytes : {1, 2}) {
        MotionAnalyzer analyzer;
        std::vector<uint8_t> pixels(static_cast<size_t>(width * height * bytes));
        for (int n = 0; n < (width * height > 5'000'000 ? 4 : 12); ++n, ++frames) {
          auto pixel = pixels.begin();
          for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
              if (bytes == 2) ++pixel;  // the high byte is the second one
              *pixel++ = static_cast<uint8_t>(content.grey(x, y, n));
            }
          }
          ImageView view{pixels.data(), width, height, static_cast<ptrdiff_t>(width) * bytes};
          view.sample = {bytes, bytes == 1 ? 0 : 8};
          const Frame& frame = analyzer.analyze(view, int64_t{40'000'000} * n);
          const double size = frame.wrench.stacked().norm();
          not_finite += !std::isfinite(size) || !frame.motion.velocity_px_s.allFinite();
          moves += size > 0;
        }
      }
    }
    std::printf("| %s | %d | %d | %d |\n", content.name, frames, moves, not_finite);
  }
}

// --- poses

/// The force that the strings give at a pose when another one is believed, without torque; where
/// both are the same, the wanted one as far as the profile's tensions reach.
Vector3d felt_N(const Profile& profile, const Pose& pose, const Pose& believed,
                const Vector3d& wanted_N) {
  TensionProblem problem;
  problem.count = profile.geometry.count;
  problem.t_min_N = problem.t_ref_N = profile.min_tension_N();
  problem.t_max_N = profile.max_tension_N();
  if (profile.geometry.grip_radius_m() > 0)
    problem.torque_length_m = profile.geometry.grip_radius_m();
  problem.W = structure_matrix(profile.geometry, believed);
  problem.wrench.force_N = wanted_N;
  const StringVector tension_N = TensionSolver().solve(problem).tension_N;
  return structure_matrix(profile.geometry, pose).topRows<3>() * tension_N;
}

/// Poses of all profiles, from 1 mm away, and more of those beyond a condition number of 100 until
/// there are kCases of them.
void print_poses() {
  constexpr double kHard = 100, kForce_N = 3;
  struct Bin {
    int cases = 0, wrong = 0;
    std::vector<double> error_m, along_N, off_N;
  };
  std::map<int, Bin> bins;  // by the decimal logarithm of the condition number, halves
  const std::vector<std::string> names = list_profiles();
  for (const std::string& name : names) {
    const Profile profile = load_profile(name);
    PoseSolver solver(profile.geometry);
    test::RandomMotion random(3);
    double reach_m = 0;
    for (int i = 0; i < profile.geometry.count; ++i)
      reach_m = std::max(reach_m, profile.geometry.exit_m[static_cast<size_t>(i)].norm());
    int hard = 0;
    constexpr int kMaxTried = 200 * kCases;
    for (int n = 0; n < kMaxTried && (n < kCases || hard * names.size() < kCases); ++n) {
      const Pose pose = random.pose(0.9 * reach_m, 1.2);
      StructureMatrix W = structure_matrix(profile.geometry, pose);
      W.bottomRows<3>() /= profile.geometry.grip_radius_m();
      const auto values = W.leftCols(profile.geometry.count).eval().jacobiSvd().singularValues();
      const bool is_hard = values[0] > kHard * values[5];
      hard += is_hard;
      if (n >= kCases && !is_hard) continue;
      Bin& bin = bins[static_cast<int>(std::floor(2 * std::log10(values[0] / values[5])))];
      Pose begin = pose;
      begin.position_m += 1e-3 * random.direction();
      begin.orientation = Eigen::AngleAxisd(0.02, random.direction()) * begin.orientation;
      solver.reset(begin);
      const PoseResult found = solver.track(string_lengths_m(profile.geometry, pose));
      ++bin.cases;
      if (found.status != PoseStatus::kSolved) continue;
      bin.error_m.push_back((found.pose.position_m - pose.position_m).norm());
      bin.wrong += !(bin.error_m.back() < 1e-6);
      const Vector3d wanted_N = kForce_N * random.direction();
      const Vector3d given_N = felt_N(profile, pose, pose, wanted_N);
      bin.along_N.push_back(given_N.dot(wanted_N) / kForce_N);
      bin.off_N.push_back((felt_N(profile, pose, found.pose, wanted_N) - given_N).norm());
    }
  }
  std::printf(
      "\n| poses, condition number | cases | solved | wrong by more than 1 µm | worst, m | along a "
      "wanted 3 N, N | off by, 99 %%, N | at most |\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& [half, bin] : bins) {
    if (bin.error_m.empty()) continue;
    std::printf("| %.0e to %.0e | %d | %.1f %% | %d | %.1e | %.2f | %.3f | %.2f |\n",
                std::pow(10, half / 2.0), std::pow(10, (half + 1) / 2.0), bin.cases,
                100.0 * static_cast<double>(bin.error_m.size()) / bin.cases, bin.wrong,
                bench::quantile(bin.error_m, 1), bench::quantile(bin.along_N, 0.5),
                bench::quantile(bin.off_N, 0.99), bench::quantile(bin.off_N, 1));
  }
}

}  // namespace

int spidar::bench::stability(int, char**) {
  std::printf(
      "| fit | points | κ | answered | error, px | not finite |\n|---|---|---|---|---|---|\n");
  for (const ModelKind kind : {ModelKind::kTranslation, ModelKind::kSimilarity, ModelKind::kAffine,
                               ModelKind::kHomography}) {
    for (const Placement& placement : placements()) print_fits(kind, placement);
  }
  print_pictures();
  print_poses();
  return 0;
}
