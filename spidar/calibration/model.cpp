// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/calibration/model.h"

#include "core/grip/singular_values.h"

namespace spidar {
namespace {

/// Displacements of all exits, stacked, that are orthogonal to shifts and small rotations of the
/// whole frame.
Eigen::MatrixXd shape_changes(const StringGeometry& geometry) {
  const int rows = 3 * geometry.count;
  Eigen::MatrixXd rigid(6, rows);
  for (int i = 0; i < geometry.count; ++i) {
    const Eigen::Vector3d& e = geometry.exit_m[static_cast<size_t>(i)];
    rigid.block<3, 3>(0, 3 * i).setIdentity();
    for (int axis = 0; axis < 3; ++axis)
      rigid.block<1, 3>(3 + axis, 3 * i) = Eigen::Vector3d::Unit(axis).cross(e).transpose();
  }
  return singular_values(rigid).directions.rightCols(rows - 6);
}

}  // namespace

CalibrationModel::CalibrationModel(const Profile& profile, const CalibrationSettings& settings)
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

StringGeometry CalibrationModel::geometry(const Eigen::VectorXd& parameters) const {
  StringGeometry moved = geometry_;
  if (exit_directions_.cols() == 0) return moved;
  const Eigen::VectorXd displacement = exit_directions_ * parameters.tail(exit_directions_.cols());
  for (int i = 0; i < moved.count; ++i)
    moved.exit_m[static_cast<size_t>(i)] += displacement.segment<3>(3 * i);
  return moved;
}

double CalibrationModel::scale(const Eigen::VectorXd& parameters) const {
  return scale_at_ < 0 ? 1.0 : 1.0 + parameters[scale_at_] / mean_length_m_;
}

StringVector CalibrationModel::home_offset_m(const Eigen::VectorXd& parameters) const {
  StringVector offset_m = home_length_m_ - string_lengths_m(geometry(parameters), {});
  offset_m.head(strings()) += parameters.head(strings());
  return offset_m;
}

StringVector CalibrationModel::paid_out_m(const Eigen::VectorXd& counts) const {
  StringVector paid_out_m = StringVector::Zero();
  paid_out_m.head(strings()) = counts.cwiseProduct(metres_per_count_.head(strings()));
  return paid_out_m;
}

Eigen::VectorXd CalibrationModel::length_errors_m(const Eigen::VectorXd& parameters,
                                                  const StringVector& paid_out_m, const Pose& pose,
                                                  Derivatives* derivatives) const {
  const int n = strings();
  const StringGeometry moved = geometry(parameters);
  const Eigen::VectorXd error_m = string_lengths_m(moved, pose).head(n) - home_length_m_.head(n) -
                                  parameters.head(n) - scale(parameters) * paid_out_m.head(n);
  if (!derivatives) return error_m;

  // A string shortens by its column of the structure matrix times the twist (virtual work).
  const StructureMatrix W = structure_matrix(moved, pose);
  derivatives->by_twist = -W.leftCols(n).transpose();
  Eigen::MatrixXd& by_parameter = derivatives->by_parameter;
  by_parameter.setZero(n, size());
  by_parameter.leftCols(n).diagonal().setConstant(-1);
  if (scale_at_ >= 0) by_parameter.col(scale_at_) = -paid_out_m.head(n) / mean_length_m_;
  if (exit_directions_.cols() > 0)
    for (int i = 0; i < n; ++i)
      by_parameter.row(i).tail(exit_directions_.cols()) =
          W.col(i).head<3>().transpose() * exit_directions_.middleRows<3>(3 * i);
  return error_m;
}

}  // namespace spidar
