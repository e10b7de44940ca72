#include "core/pose_solver.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include <ceres/tiny_solver.h>

namespace spidar {
namespace {

Eigen::Quaterniond rotation(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (!(angle > 0)) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle));
}

// Left Jacobian of SO(3) (Solà, Deray, Atchuthan 2018, eq. 145): how the rotation changes, seen
// from the device frame, with its rotation vector.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  Eigen::Matrix3d K;
  K << 0, -vector.z(), vector.y(), vector.z(), 0, -vector.x(), -vector.y(), vector.x(), 0;
  const double a = angle > 1e-4 ? (1 - std::cos(angle)) / (angle * angle) : 0.5;
  const double b = angle > 1e-4 ? (angle - std::sin(angle)) / (angle * angle * angle) : 1.0 / 6;
  return Eigen::Matrix3d::Identity() + a * K + b * K * K;
}

// Length errors over a step from `start`: translation and rotation vector, the latter times the
// grip radius so that both are metres. Units of the residual are chosen so that 1e-8 m counts as 1:
// TinySolver 2.1 compares costs absolutely.
struct LengthErrors {
  using Scalar = double;
  enum { NUM_RESIDUALS = kMaxStrings, NUM_PARAMETERS = 6 };
  static constexpr double kUnit_m = 1e-8;

  const StringGeometry& geometry;
  const StringVector& lengths_m;
  Pose start;
  double radius_m;

  Pose moved(const double* step) const {
    Pose pose = start;
    pose.position_m += Eigen::Map<const Eigen::Vector3d>(step);
    const Eigen::Vector3d vector = Eigen::Map<const Eigen::Vector3d>(step + 3) / radius_m;
    pose.orientation = (rotation(vector) * start.orientation).normalized();
    return pose;
  }

  bool operator()(const double* step, double* residuals, double* jacobian) const {
    const Pose pose = moved(step);
    Eigen::Map<StringVector> r(residuals);
    r = (string_lengths_m(geometry, pose) - lengths_m) / kUnit_m;
    r.tail(kMaxStrings - geometry.count).setZero();
    if (jacobian) {
      // A string shortens by the structure matrix' column times the twist (virtual work).
      Eigen::Map<Eigen::Matrix<double, kMaxStrings, 6>> J(jacobian);
      J = -structure_matrix(geometry, pose).transpose() / kUnit_m;
      const Eigen::Vector3d vector = Eigen::Map<const Eigen::Vector3d>(step + 3) / radius_m;
      J.rightCols<3>() = (J.rightCols<3>() * left_jacobian(vector) / radius_m).eval();
    }
    return true;
  }
};

}  // namespace

PoseSolver::PoseSolver(const StringGeometry& geometry) : geometry_(geometry) {
  if (geometry.count < 6)
    throw std::invalid_argument("a pose has six unknowns and needs at least six strings, not " +
                                std::to_string(geometry.count));
  if (!(geometry.grip_radius_m() > 0))
    throw std::invalid_argument(
        "strings that all meet in the grip's origin do not tell how it is "
        "turned: at least one must be tied away from it");
}

PoseResult PoseSolver::solve(const StringVector& lengths_m) noexcept {
  PoseResult result;
  result.pose = last_;
  for (int i = 0; i < geometry_.count; ++i)
    if (!std::isfinite(lengths_m[i]) || lengths_m[i] < 0) return result;

  const LengthErrors errors{geometry_, lengths_m, last_, geometry_.grip_radius_m()};
  ceres::TinySolver<LengthErrors> solver;
  Eigen::Matrix<double, 6, 1> step = Eigen::Matrix<double, 6, 1>::Zero();
  const auto& summary = solver.Solve(errors, &step);

  result.iterations = summary.iterations;
  result.residual_m = std::sqrt(2 * summary.final_cost / geometry_.count) * LengthErrors::kUnit_m;
  if (step.allFinite() && result.residual_m <= kMaxResidual_m) {
    last_ = errors.moved(step.data());
    result.status = PoseStatus::kSolved;
  } else {
    result.status = PoseStatus::kNotConverged;
  }
  result.pose = last_;
  return result;
}

}  // namespace spidar
