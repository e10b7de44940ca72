// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/bundle_adjustment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <Eigen/Geometry>
#include <ceres/ceres.h>

#include "core/quantile.h"

namespace spidar {
namespace {

/// A pose as [position, quaternion x y z w], perturbed by a shift and a rotation in D.
using PoseManifold =
    ceres::ProductManifold<ceres::EuclideanManifold<3>, ceres::EigenQuaternionManifold>;
constexpr int kPoseSize = 7;
using PoseBlock = Eigen::Matrix<double, kPoseSize, 1>;

PoseBlock to_block(const Pose& pose) {
  PoseBlock block;
  block << pose.position_m, pose.orientation.coeffs();
  return block;
}

Pose to_pose(const double* block) {
  return {Eigen::Map<const Eigen::Vector3d>(block),
          Eigen::Map<const Eigen::Quaterniond>(block + 3)};
}

/// One sample: one residual for each string, in units of `unit_m`.
class SampleErrors final : public ceres::CostFunction {
 public:
  SampleErrors(const CalibrationModel& model, const StringVector& paid_out_m, double unit_m)
      : model_(model), paid_out_m_(paid_out_m), unit_m_(unit_m) {
    set_num_residuals(model.strings());
    *mutable_parameter_block_sizes() = {kPoseSize, model.size()};
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const int n = model_.strings();
    const Eigen::VectorXd parameters = Eigen::Map<const Eigen::VectorXd>(blocks[1], model_.size());
    CalibrationModel::Derivatives derivatives;
    Eigen::Map<Eigen::VectorXd>(residuals, n) =
        model_.length_errors_m(parameters, paid_out_m_, to_pose(blocks[0]),
                               jacobians ? &derivatives : nullptr) /
        unit_m_;
    if (!jacobians) return true;
    if (jacobians[0]) {
      // A rotation of the manifold is half a rotation vector. Ceres multiplies by dPlus, whose left
      // inverse is dMinus.
      Eigen::Matrix<double, 6, kPoseSize, Eigen::RowMajor> minus;
      if (!PoseManifold().MinusJacobian(blocks[0], minus.data())) return false;
      derivatives.by_twist.rightCols<3>() *= 2;
      Eigen::Map<Rows>(jacobians[0], n, kPoseSize) = derivatives.by_twist * minus / unit_m_;
    }
    if (jacobians[1])
      Eigen::Map<Rows>(jacobians[1], n, model_.size()) = derivatives.by_parameter / unit_m_;
    return true;
  }

 private:
  const CalibrationModel& model_;
  StringVector paid_out_m_;
  double unit_m_;
};

}  // namespace

void adjust(const CalibrationModel& model, const std::vector<StringVector>& paid_out_m,
            double sigma_m, Adjust what, int max_iterations, Bundle& bundle) {
  const bool robust = std::isfinite(sigma_m);
  const double unit_m = robust ? sigma_m : 1e-3;
  ceres::HuberLoss loss(kHuber);
  PoseManifold manifold;
  ceres::Problem::Options owned_here;
  owned_here.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  owned_here.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(owned_here);

  std::vector<PoseBlock> blocks(bundle.poses.size());
  auto elimination_order = std::make_shared<ceres::ParameterBlockOrdering>();
  double* parameters = bundle.parameters.data();
  problem.AddParameterBlock(parameters, model.size());
  elimination_order->AddElementToGroup(parameters, 1);
  for (size_t k = 0; k < blocks.size(); ++k) {
    blocks[k] = to_block(bundle.poses[k]);
    problem.AddParameterBlock(blocks[k].data(), kPoseSize, &manifold);
    elimination_order->AddElementToGroup(blocks[k].data(), 0);
    problem.AddResidualBlock(new SampleErrors(model, paid_out_m[k], unit_m),
                             robust ? &loss : nullptr, blocks[k].data(), parameters);
  }
  if (what == Adjust::kPoses) problem.SetParameterBlockConstant(parameters);

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = elimination_order;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (size_t k = 0; k < blocks.size(); ++k) bundle.poses[k] = to_pose(blocks[k].data());
}

namespace {

constexpr double kPlain = std::numeric_limits<double>::infinity();
constexpr size_t kFew = 40;
constexpr int kMaxStartIterations = 100;
constexpr int kMaxRepairs = 4;
// A sample that has converged to a wrong minimum has a residual far above the others.
constexpr double kBad = 2.0;
constexpr double kGood = 1.5;

/// Poses at which the counters may have been cleared: unrotated, or rotated by 1 rad about the axes
/// and the diagonals of the cube. Every rotation of up to 80° is within 0.7 rad of one of them.
std::vector<Pose> starts() {
  std::vector<Pose> poses(1);
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const int axes = std::abs(x) + std::abs(y) + std::abs(z);
        if (axes != 1 && axes != 3) continue;
        Pose pose;
        pose.orientation = Eigen::AngleAxisd(1.0, Eigen::Vector3d(x, y, z).normalized());
        poses.push_back(pose);
      }
  return poses;
}

std::vector<double> errors_m(const CalibrationModel& model,
                             const std::vector<StringVector>& paid_out_m, const Bundle& bundle) {
  std::vector<double> errors;
  for (size_t k = 0; k < paid_out_m.size(); ++k)
    errors.push_back(
        model.length_errors_m(bundle.parameters, paid_out_m[k], bundle.poses[k], nullptr).norm());
  return errors;
}

double rms_m(const CalibrationModel& model, const std::vector<double>& errors) {
  double sum = 0;
  for (const double error : errors) sum += error * error;
  return std::sqrt(sum / static_cast<double>(errors.size() * static_cast<size_t>(model.strings())));
}

/// Index of the allowed sample (`may`) whose lengths are closest to `lengths`.
template <typename May>
size_t nearest(const std::vector<StringVector>& samples, const StringVector& lengths, May may) {
  size_t best = samples.size();
  double distance = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < samples.size(); ++k) {
    const double d = (samples[k] - lengths).squaredNorm();
    if (d >= distance || !may(k)) continue;
    best = k;
    distance = d;
  }
  return best;
}

struct Candidate {
  Bundle bundle;
  std::vector<double> errors;
  double rms = 0;
};

class Search {
 public:
  Search(const CalibrationModel& model, const std::vector<StringVector>& samples)
      : model_(model), samples_(samples) {}

  /// Fits with all poses starting at `start`. Poses that end in wrong minima are restarted at the
  /// pose of their nearest neighbour, as long as that helps.
  Candidate from(const Pose& start) const {
    Candidate best = fitted({model_.cleared_at(start), std::vector<Pose>(samples_.size(), start)});
    for (int repair = 0; repair < kMaxRepairs; ++repair) {
      Candidate next = fitted(repaired(best));
      if (!(next.rms < (1 - 1e-3) * best.rms)) break;
      best = std::move(next);
    }
    return best;
  }

 private:
  Candidate fitted(Bundle bundle) const {
    adjust(model_, samples_, kPlain, Adjust::kAll, kMaxStartIterations, bundle);
    Candidate candidate{std::move(bundle), {}, 0};
    candidate.errors = errors_m(model_, samples_, candidate.bundle);
    candidate.rms = rms_m(model_, candidate.errors);
    return candidate;
  }

  Bundle repaired(const Candidate& candidate) const {
    const std::vector<double>& errors = candidate.errors;
    const double typical = median(errors);
    Bundle bundle = candidate.bundle;
    for (size_t k = 0; k < samples_.size(); ++k) {
      if (errors[k] <= kBad * typical) continue;
      const auto is_good = [&](size_t j) { return errors[j] <= kGood * typical; };
      bundle.poses[k] = candidate.bundle.poses[nearest(samples_, samples_[k], is_good)];
    }
    return bundle;
  }

  const CalibrationModel& model_;
  const std::vector<StringVector>& samples_;
};

}  // namespace

Bundle find_bundle(const CalibrationModel& model, const std::vector<StringVector>& paid_out_m,
                   double sure_m) {
  const size_t count = paid_out_m.size();
  std::vector<StringVector> few;
  for (size_t i = 0; i < std::min(kFew, count); ++i)
    few.push_back(paid_out_m[i * count / std::min(kFew, count)]);

  const Search search(model, few);
  Candidate best;
  for (const Pose& start : starts()) {
    Candidate candidate = search.from(start);
    if (best.errors.empty() || candidate.rms < best.rms) best = std::move(candidate);
    if (best.rms <= sure_m) break;
  }

  Bundle all{best.bundle.parameters, {}};
  const auto any = [](size_t) { return true; };
  for (const StringVector& lengths : paid_out_m)
    all.poses.push_back(best.bundle.poses[nearest(few, lengths, any)]);
  adjust(model, paid_out_m, kPlain, Adjust::kPoses, kMaxStartIterations, all);
  return all;
}

}  // namespace spidar
