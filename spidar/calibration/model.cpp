// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/model.h"

#include <limits>
#include <memory>

#include <Eigen/Geometry>
#include <ceres/ceres.h>

#include "core/grip/matrices.h"
#include "core/grip/pose_solver.h"

namespace spidar::calibration {
namespace {

/// Displacements of all exits, stacked, orthogonal to shifts and small rotations of the frame.
Eigen::MatrixXd shape_changes(const StringGeometry& geometry) {
  const int rows = 3 * geometry.count;
  Eigen::MatrixXd rigid(6, rows);
  for (int i = 0; i < geometry.count; ++i) {
    const Eigen::Vector3d& e = geometry.exit_m[static_cast<size_t>(i)];
    rigid.block<3, 3>(0, 3 * i).setIdentity();
    for (int axis = 0; axis < 3; ++axis) {
      rigid.block<1, 3>(3 + axis, 3 * i) = Eigen::Vector3d::Unit(axis).cross(e).transpose();
    }
  }
  return singular_values(rigid).directions.rightCols(rows - 6);
}

}  // namespace

Model::Model(const Profile& profile, const Settings& settings)
    : geometry_(profile.geometry),
      home_length_m_(string_lengths_m(profile.geometry, {})),
      metres_per_count_(StringVector::Zero()),
      mean_length_m_(home_length_m_.head(profile.geometry.count).mean()),
      scale_at_(settings.free_scale ? profile.geometry.count : -1),
      exits_at_(profile.geometry.count + (settings.free_scale ? 1 : 0)) {
  for (int i = 0; i < geometry_.count; ++i) {
    const StringDrive& drive = profile.drives[static_cast<size_t>(i)];
    metres_per_count_[i] = drive.encoder_sign * drive.metres_per_count;
  }
  if (settings.free_exits) exit_directions_ = shape_changes(geometry_);
}

StringGeometry Model::geometry(const Eigen::VectorXd& parameters) const {
  StringGeometry moved = geometry_;
  if (exit_directions_.cols() == 0) return moved;
  const Eigen::VectorXd displacement = exit_directions_ * parameters.tail(exit_directions_.cols());
  for (int i = 0; i < moved.count; ++i) {
    moved.exit_m[static_cast<size_t>(i)] += displacement.segment<3>(3 * i);
  }
  return moved;
}

double Model::scale(const Eigen::VectorXd& parameters) const {
  return scale_at_ < 0 ? 1.0 : 1.0 + parameters[scale_at_] / mean_length_m_;
}

StringVector Model::home_offset_m(const Eigen::VectorXd& parameters) const {
  StringVector offset_m = home_length_m_ - string_lengths_m(geometry(parameters), {});
  offset_m.head(strings()) += parameters.head(strings());
  return offset_m;
}

StringVector Model::paid_out_m(const Eigen::VectorXd& counts) const {
  StringVector paid_out_m = StringVector::Zero();
  paid_out_m.head(strings()) = counts.cwiseProduct(metres_per_count_.head(strings()));
  return paid_out_m;
}

Eigen::VectorXd Model::length_errors_m(const Eigen::VectorXd& parameters,
                                       const StringVector& paid_out_m, const Pose& pose,
                                       Derivatives* derivatives) const {
  const int n = strings();
  const StringGeometry moved = geometry(parameters);
  const Eigen::VectorXd error_m = string_lengths_m(moved, pose).head(n) - home_length_m_.head(n) -
                                  parameters.head(n) - scale(parameters) * paid_out_m.head(n);
  if (!derivatives) return error_m;

  // By virtual work, a string shortens by its column of the structure matrix times the twist.
  const StructureMatrix W = structure_matrix(moved, pose);
  derivatives->by_twist = -W.leftCols(n).transpose();
  Eigen::MatrixXd& by_parameter = derivatives->by_parameter;
  by_parameter.setZero(n, size());
  by_parameter.leftCols(n).diagonal().setConstant(-1);
  if (scale_at_ >= 0) by_parameter.col(scale_at_) = -paid_out_m.head(n) / mean_length_m_;
  if (exit_directions_.cols() > 0) {
    for (int i = 0; i < n; ++i) {
      by_parameter.row(i).tail(exit_directions_.cols()) =
          W.col(i).head<3>().transpose() * exit_directions_.middleRows<3>(3 * i);
    }
  }
  return error_m;
}

namespace {

/// A pose as [position, quaternion x y z w], perturbed by a shift and a rotation in D.
using PoseManifold =
    ceres::ProductManifold<ceres::EuclideanManifold<3>, ceres::EigenQuaternionManifold>;
constexpr int kPoseSize = 7;

Eigen::Matrix<double, kPoseSize, 1> to_block(const Pose& pose) {
  Eigen::Matrix<double, kPoseSize, 1> block;
  block << pose.position_m, pose.orientation.coeffs();
  return block;
}

Pose to_pose(const double* block) {
  return {Eigen::Map<const Eigen::Vector3d>(block),
          Eigen::Map<const Eigen::Quaterniond>(block + 3)};
}

/// The residuals of one sample: one for each string, in units of `unit_m`.
class SampleErrors final : public ceres::CostFunction {
 public:
  SampleErrors(const Model& model, const StringVector& paid_out_m, double unit_m)
      : model_(model), paid_out_m_(paid_out_m), unit_m_(unit_m) {
    set_num_residuals(model.strings());
    *mutable_parameter_block_sizes() = {kPoseSize, model.size()};
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const int n = model_.strings();
    const Eigen::VectorXd parameters = Eigen::Map<const Eigen::VectorXd>(blocks[1], model_.size());
    Model::Derivatives derivatives;
    Eigen::Map<Eigen::VectorXd>(residuals, n) =
        model_.length_errors_m(parameters, paid_out_m_, to_pose(blocks[0]),
                               jacobians ? &derivatives : nullptr) /
        unit_m_;
    if (!jacobians) return true;
    if (jacobians[0]) {
      // The manifold's rotation is half a rotation vector. Ceres multiplies by dPlus, whose left
      // inverse is dMinus.
      Eigen::Matrix<double, 6, kPoseSize, Eigen::RowMajor> minus;
      if (!PoseManifold().MinusJacobian(blocks[0], minus.data())) return false;
      derivatives.by_twist.rightCols<3>() *= 2;
      Eigen::Map<Rows>(jacobians[0], n, kPoseSize) = derivatives.by_twist * minus / unit_m_;
    }
    if (jacobians[1]) {
      Eigen::Map<Rows>(jacobians[1], n, model_.size()) = derivatives.by_parameter / unit_m_;
    }
    return true;
  }

 private:
  const Model& model_;
  StringVector paid_out_m_;
  double unit_m_;
};

}  // namespace

void adjust(const Model& model, const std::vector<StringVector>& paid_out_m, double sigma_m,
            int max_iterations, Bundle& bundle) {
  ceres::HuberLoss loss(kHuber);
  PoseManifold manifold;
  ceres::Problem::Options owned_here;
  owned_here.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  owned_here.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(owned_here);

  std::vector<Eigen::Matrix<double, kPoseSize, 1>> blocks(bundle.poses.size());
  auto elimination_order = std::make_shared<ceres::ParameterBlockOrdering>();
  double* parameters = bundle.parameters.data();
  problem.AddParameterBlock(parameters, model.size());
  elimination_order->AddElementToGroup(parameters, 1);
  for (size_t k = 0; k < blocks.size(); ++k) {
    blocks[k] = to_block(bundle.poses[k]);
    problem.AddParameterBlock(blocks[k].data(), kPoseSize, &manifold);
    elimination_order->AddElementToGroup(blocks[k].data(), 0);
    problem.AddResidualBlock(new SampleErrors(model, paid_out_m[k], sigma_m), &loss,
                             blocks[k].data(), parameters);
  }

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = elimination_order;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  // A solve that fails leaves the start, whose residuals the caller judges.
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (size_t k = 0; k < blocks.size(); ++k) bundle.poses[k] = to_pose(blocks[k].data());
}

Bundle from_the_centre(const Model& model, const std::vector<StringVector>& paid_out_m) {
  const StringVector& centre_m = paid_out_m.front();
  Bundle start{Eigen::VectorXd::Zero(model.size()), {}};
  start.parameters.head(model.strings()) = -centre_m.head(model.strings());
  const StringGeometry geometry = model.geometry(start.parameters);
  const StringVector zero_m = string_lengths_m(geometry, {}) - centre_m;
  PoseSolver solver(geometry, std::numeric_limits<double>::infinity());
  for (const StringVector& lengths_m : paid_out_m) {
    start.poses.push_back(solver.solve(zero_m + lengths_m).pose);
  }
  return start;
}

}  // namespace spidar::calibration
