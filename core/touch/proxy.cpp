// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/proxy.h"

#include <cmath>

#include "core/touch/relief.h"

namespace spidar::touch {
namespace {

/// Largest slope of a relief in any direction: kMaxSlope along both axes.
const double kSteepest = ReliefBuilder::kMaxSlope * std::sqrt(2.0);
/// A sliding proxy sticks again when its tangential distance to the grip falls below this fraction
/// of the distance at which it slides, as when the hand reverses.
constexpr double kSticksAgain = 0.6;
/// Shorter steps are skipped: at 500 N/m, 1 nm corresponds to 0.5 µN.
constexpr double kMinStep_m = 1e-9;
constexpr int kMaxHalvings = 3;

}  // namespace

void Proxy::move(const MovingRelief& surface, double friction, const Eigen::Vector3d& grip_m,
                 double dt_s) noexcept {
  if (!grip_m.allFinite()) {
    reset();
    return;
  }
  const double shift_m = settled_m(dt_s);
  stretched_m2_ = 0;
  if (touching_) {
    carry(surface, shift_m, grip_m, dt_s);
  } else {
    // Without contact a raised surface may fall immediately.
    enter(surface, std::min(shift_m, 0.0), grip_m, dt_s);
  }
  if (touching_) walk(surface, friction, grip_m);
  last_grip_m_ = grip_m;
  started_ = true;
}

/// Reduces the shift of the surface. The surface falls faster than it rises, because a falling
/// surface gives no energy.
double Proxy::settled_m(double dt_s) noexcept {
  if (shift_m_ >= 0) {
    rise_m_s_ = 0;
    return std::max(0.0, shift_m_ - kFastest_m_s * dt_s);
  }
  rise_m_s_ = std::min(kRise_m_s, rise_m_s_ + kRise_m_s2 * dt_s);
  return std::min(0.0, shift_m_ + rise_m_s_ * dt_s);
}

/// Moves the proxy with the surface, at most at kFastest_m_s.
void Proxy::carry(const MovingRelief& surface, double shift_m, const Eigen::Vector3d& grip_m,
                  double dt_s) noexcept {
  const SurfacePoint at = surface.at(position_m_.head<2>());
  const double rise_m = at.z_m + shift_m - position_m_.z();
  const double most_m = kFastest_m_s * dt_s;
  const double before_m2 = (position_m_ - grip_m).squaredNorm();
  position_m_.z() += std::clamp(rise_m, -most_m, most_m);
  stretched_m2_ = (position_m_ - grip_m).squaredNorm() - before_m2;
  shift_m_ = position_m_.z() - at.z_m;
  normal_ = at.normal();
}

/// Starts contact if the grip is below the surface. The part of the depth that the motion of the
/// grip since the last tick does not explain counts as a jump of the surface.
void Proxy::enter(const MovingRelief& surface, double shift_m, const Eigen::Vector3d& grip_m,
                  double dt_s) noexcept {
  const SurfacePoint at = surface.at(grip_m.head<2>());
  const double depth_m = at.z_m + shift_m - grip_m.z();
  shift_m_ = shift_m;
  position_m_ = grip_m;
  if (!(depth_m > 0)) return;
  double explained_m = kFastest_m_s * dt_s;
  if (started_) {
    const Eigen::Vector3d moved_m = grip_m - last_grip_m_;
    explained_m += std::max(0.0, -moved_m.z()) + kSteepest * moved_m.head<2>().norm();
  }
  if (depth_m > explained_m) shift_m_ -= depth_m - explained_m;
  touching_ = true;
  sliding_ = false;
  position_m_.z() = at.z_m + shift_m_;
  normal_ = at.normal();
}

void Proxy::walk(const MovingRelief& surface, double friction,
                 const Eigen::Vector3d& grip_m) noexcept {
  const double longest_m = 0.5 * surface.cell_m();
  for (int n = 0; n < kMostSteps; ++n) {
    const Eigen::Vector3d to_grip_m = grip_m - position_m_;
    const double depth_m = -normal_.dot(to_grip_m);
    // A grip above the tangent plane may still be below a concave surface.
    if (depth_m <= 0 && grip_m.z() >= surface.at(grip_m.head<2>()).z_m + shift_m_) {
      lose_contact(grip_m);
      return;
    }
    const Eigen::Vector3d along_m = to_grip_m + depth_m * normal_;
    const double distance_m = along_m.norm();
    double held_m = 0;  // distance at which friction holds a sliding proxy
    if (depth_m > 0 && friction > 0) {
      held_m = kKineticFriction * friction * depth_m;
      if (sliding_ && distance_m < kSticksAgain * held_m) sliding_ = false;
      if (!sliding_ && distance_m <= friction * depth_m) return;
    }
    const double length_m = std::min(distance_m - held_m, longest_m);
    if (!(length_m > kMinStep_m)) return;
    sliding_ = true;
    if (!step(surface, along_m * (length_m / distance_m), grip_m)) return;
  }
}

/// Moves by `step_m`, or a fraction of it, along the tangent plane and back onto the surface.
/// Returns false if no such step ends closer to the grip.
bool Proxy::step(const MovingRelief& surface, const Eigen::Vector3d& step_m,
                 const Eigen::Vector3d& grip_m) noexcept {
  const double now_m2 = (position_m_ - grip_m).squaredNorm();
  double fraction = 1;
  for (int n = 0; n <= kMaxHalvings; ++n, fraction *= 0.5) {
    Eigen::Vector3d there_m = position_m_ + fraction * step_m;
    const SurfacePoint at = surface.at(there_m.head<2>());
    there_m.z() = at.z_m + shift_m_;
    if ((there_m - grip_m).squaredNorm() < now_m2) {
      position_m_ = there_m;
      normal_ = at.normal();
      return true;
    }
  }
  return false;
}

void Proxy::lose_contact(const Eigen::Vector3d& grip_m) noexcept {
  touching_ = false;
  sliding_ = false;
  position_m_ = grip_m;
}

}  // namespace spidar::touch
