// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/bundle_adjustment.h"

#include <cmath>
#include <memory>
#include <random>

#include <ceres/ceres.h>

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

Eigen::VectorXd noise_bias(const CalibrationModel& model,
                           const std::vector<StringVector>& paid_out_m, double sigma_m,
                           int max_iterations, const Bundle& bundle) {
  const int n = model.strings();
  const double scale = model.scale(bundle.parameters);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, sigma_m);
  std::vector<StringVector> above, below;
  for (size_t k = 0; k < paid_out_m.size(); ++k) {
    StringVector exact_m = paid_out_m[k], noise_m = StringVector::Zero();
    exact_m.head(n) +=
        model.length_errors_m(bundle.parameters, paid_out_m[k], bundle.poses[k], nullptr) / scale;
    for (int i = 0; i < n; ++i) noise_m[i] = normal(random) / scale;
    above.push_back(exact_m + noise_m);
    below.push_back(exact_m - noise_m);
  }
  Bundle up = bundle, down = bundle;
  adjust(model, above, sigma_m, Adjust::kAll, max_iterations, up);
  adjust(model, below, sigma_m, Adjust::kAll, max_iterations, down);
  return (up.parameters + down.parameters) / 2 - bundle.parameters;
}

}  // namespace spidar
