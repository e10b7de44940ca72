// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/grip/pose_fit.h"

#include <algorithm>
#include <cmath>

#include "core/grip/matrices.h"

namespace spidar {
namespace {

// The error after a Gauss–Newton step is about half its square over the string length: 50 µm leave
// less than 0.06 µm at 2 cm, a hundredth of an encoder's quantisation error.
constexpr double kLastStep_m = 50e-6;
constexpr int kMaxTrackingSteps = 4;
// A search decides between minima, so it ends with smaller steps.
constexpr double kLastSearchStep_m = 1e-9;
constexpr int kMaxSearchSteps = 40;
constexpr double kNoCost_m2 = 1e-24;
constexpr double kLittleDamping = 1e-4;
// The longest step of the search: the model is linear over some centimetres only.
constexpr double kLongestStep_m = 0.02;
// Near the walls of the frame, wrong minima have residuals down to 20 µm; at the right one,
// quantisation leaves some 3 µm. Above this limit, all starts are tried and the best fit wins.
constexpr double kSureResidual_m = 10e-6;
// In the box of the SPIDAR-G6X3, the two poses differ by a rotation of 0.7 to 1.7 rad times the
// smallest singular value (rotations scaled by the grip radius), and the ridge between them is half
// way.
constexpr double kBesideStep = 1.5;
// A smaller distance is the same minimum: searches end within some steps of kLastSearchStep_m.
constexpr double kSamePose_m = 1e-6;

StringVector weights(int count, int left_out, int also = -1) {
  StringVector w = StringVector::Zero();
  w.head(count).setOnes();
  if (left_out >= 0) w[left_out] = 0;
  if (also >= 0) w[also] = 0;
  return w;
}

bool solve(const NormalEquations& equations, double damping, const Twist& rhs, Twist& solution) {
  constexpr int kAll[6] = {0, 1, 2, 3, 4, 5};
  return solve_ldlt(6, equations.H, damping, kAll, rhs.data(), solution.data());
}

// Rotations by 1 rad about the axes and the diagonals of the cube: every rotation by up to 80° is
// within 0.7 rad of one of them or of no rotation.
Pose restart(int n) {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  if (n < 6) {
    axis[n / 2] = n % 2 ? -1 : 1;
  } else {
    for (int k = 0; k < 3; ++k) axis[k] = ((n - 6) >> k & 1 ? 1 : -1) / std::sqrt(3.0);
  }
  Pose pose;
  pose.orientation = Eigen::AngleAxisd(1.0, axis);
  return pose;
}
constexpr int kRestarts = 14;

// The direction in which the lengths change least, times the smallest singular value of J: by
// inverse iteration on H = JᵀJ, which converges fast where that value is by far the smallest.
Twist weakest_direction(const NormalEquations& equations) {
  constexpr int kIterations = 6;
  Twist direction;
  direction << 0.3, -0.4, 0.5, -0.4, 0.3, 0.5;
  direction.normalize();
  double eigenvalue = 0;
  for (int i = 0; i < kIterations; ++i) {
    Twist next;
    if (!solve(equations, 0, direction, next)) break;
    eigenvalue = 1 / next.norm();
    direction = next * eigenvalue;
  }
  return std::sqrt(eigenvalue) * direction;
}

}  // namespace

PoseFitter::PoseFitter(const StringGeometry& geometry)
    : count_(geometry.count), radius_m_(geometry.grip_radius_m()) {
  // Unused strings get a length, so that nothing is divided by zero.
  exit_m_.setOnes();
  grip_m_.setZero();
  for (int i = 0; i < count_; ++i) {
    exit_m_.col(i) = geometry.exit_m[static_cast<size_t>(i)];
    grip_m_.col(i) = geometry.grip_m[static_cast<size_t>(i)];
  }
}

Pose PoseFitter::moved(const Pose& pose, const Twist& twist) const noexcept {
  Pose result;
  result.position_m = pose.position_m + twist.head<3>();
  // Cayley's map: the rotation vector to second order, without trigonometry.
  const Eigen::Vector3d half = twist.tail<3>() * (0.5 / radius_m_);
  const Eigen::Quaterniond turn(1, half.x(), half.y(), half.z());
  result.orientation = (turn * pose.orientation).normalized();
  return result;
}

Twist PoseFitter::twist(const Pose& from, const Pose& to) const noexcept {
  const Eigen::Quaterniond turn = to.orientation * from.orientation.conjugate();
  Twist result;
  result << to.position_m - from.position_m, turn.vec() * (2 * radius_m_ / turn.w());
  return result;
}

void PoseFitter::linearise(const Pose& pose, const StringVector& length_m,
                           const StringVector& weight, NormalEquations& equations) const noexcept {
  constexpr double kNoLength = 1e-12;
  const Eigen::Matrix<double, 3, kMaxStrings> arm =
      pose.orientation.toRotationMatrix().lazyProduct(grip_m_);
  const Eigen::Matrix<double, 3, kMaxStrings> string = (exit_m_ - arm).colwise() - pose.position_m;
  const StringVector length = string.colwise().norm();
  const StringVector scale = weight.cwiseQuotient(length.cwiseMax(kNoLength));
  const StringVector r = weight.cwiseProduct(length - length_m);
  // −J: its sign cancels in H, and in g = −Σ J r.
  StructureMatrix minus_J;
  for (int i = 0; i < kMaxStrings; ++i) {
    const Eigen::Vector3d unit = scale[i] * string.col(i);
    minus_J.col(i) << unit, arm.col(i).cross(unit) / radius_m_;
  }
  equations.H.noalias() = minus_J * minus_J.transpose();
  equations.g.noalias() = minus_J * r;
  equations.cost_m2 = r.squaredNorm();
}

PoseFit PoseFitter::gauss_newton(const StringVector& lengths_m, const Pose& start, int left_out,
                                 int also) const noexcept {
  const StringVector w = weights(count_, left_out, also);
  const int used = count_ - (left_out >= 0) - (also >= 0);
  PoseFit fit{start, 0, 0, false};
  NormalEquations equations;
  while (fit.iterations < kMaxTrackingSteps && !fit.converged) {
    ++fit.iterations;
    linearise(fit.pose, lengths_m, w, equations);
    Twist step;
    if (!solve(equations, 0, equations.g, step)) break;
    fit.pose = moved(fit.pose, step);
    // The cost of the linear model after the step, which is the true cost where the step is short.
    const double cost_m2 = std::max(0.0, equations.cost_m2 - equations.g.dot(step));
    fit.residual_m = std::sqrt(cost_m2 / used);
    fit.converged = step.squaredNorm() <= kLastStep_m * kLastStep_m;
  }
  return fit;
}

PoseFit PoseFitter::levenberg_marquardt(const StringVector& lengths_m, const Pose& start,
                                        int left_out) const noexcept {
  const StringVector w = weights(count_, left_out);
  const int used = count_ - (left_out >= 0);
  PoseFit fit{start, 0, 0, false};
  NormalEquations equations;
  linearise(fit.pose, lengths_m, w, equations);
  double damping = 0;
  while (fit.iterations < kMaxSearchSteps && !fit.converged) {
    ++fit.iterations;
    Twist step;
    if (!solve(equations, damping, equations.g, step)) {
      damping = std::max(kLittleDamping, 10 * damping);
      continue;
    }
    const double length_m = step.norm();
    if (length_m > kLongestStep_m) step *= kLongestStep_m / length_m;
    const Pose pose = moved(fit.pose, step);
    NormalEquations there;
    linearise(pose, lengths_m, w, there);
    // A step that damping has shortened does not show how near the minimum is.
    fit.converged =
        (length_m <= kLastSearchStep_m && damping <= kLittleDamping) || there.cost_m2 <= kNoCost_m2;
    if (there.cost_m2 < equations.cost_m2) {
      fit.pose = pose;
      equations = there;
      damping = damping > 1e-6 ? damping / 10 : 0;
    } else {
      damping = std::max(kLittleDamping, 10 * damping);
    }
  }
  fit.residual_m = std::sqrt(equations.cost_m2 / used);
  return fit;
}

PoseFit PoseFitter::search(const StringVector& lengths_m, const Pose& start) const noexcept {
  PoseFit best = levenberg_marquardt(lengths_m, start, -1);
  for (int n = 0; n < kRestarts && !(best.converged && best.residual_m <= kSureResidual_m); ++n) {
    const PoseFit fit = levenberg_marquardt(lengths_m, restart(n), -1);
    const int iterations = best.iterations + fit.iterations;
    if (fit.residual_m < best.residual_m) best = fit;
    best.iterations = iterations;
  }
  return best;
}

PoseFit PoseFitter::beside(const StringVector& lengths_m, const PoseFit& fit,
                           int left_out) const noexcept {
  NormalEquations equations;
  linearise(fit.pose, lengths_m, weights(count_, left_out), equations);
  const Twist direction = weakest_direction(equations);
  PoseFit best;
  int iterations = 0;
  for (const double side : {kBesideStep, -kBesideStep}) {
    const Pose start = moved(fit.pose, side * radius_m_ * direction);
    const PoseFit other = levenberg_marquardt(lengths_m, start, left_out);
    iterations += other.iterations;
    const bool distinct = twist(fit.pose, other.pose).norm() > kSamePose_m;
    if (other.converged && distinct && (!best.converged || other.residual_m < best.residual_m)) {
      best = other;
    }
  }
  best.iterations = iterations;
  return best;
}

}  // namespace spidar
