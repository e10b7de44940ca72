// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "core/touch/height_field.h"

namespace spidar::touch {

/// Interpolates between two reliefs with fraction s and displacement u:
/// h(p) = (1 − s) before(p − s u) + s after(p + (1 − s) u).
/// An object that moves by u from one frame to the next keeps its shape;
/// plain cross-fading would show it twice. Does not own the fields.
struct MovingRelief {
  const HeightField* before = nullptr;  ///< must not be null
  const HeightField* after = nullptr;   ///< null: only `before`, which is static
  double fraction = 0;                  ///< of `after`, 0 … 1
  Eigen::Vector2d displacement_m = Eigen::Vector2d::Zero();

  SurfacePoint at(const Eigen::Vector2d& position_m) const noexcept {
    if (after == nullptr) return before->at(position_m.x(), position_m.y());
    const Eigen::Vector2d p = position_m - fraction * displacement_m;
    const Eigen::Vector2d q = position_m + (1 - fraction) * displacement_m;
    const SurfacePoint a = before->at(p.x(), p.y());
    const SurfacePoint b = after->at(q.x(), q.y());
    return {a.z_m + fraction * (b.z_m - a.z_m), a.slope + fraction * (b.slope - a.slope)};
  }

  double cell_m() const noexcept { return std::min(before->cell_x_m(), before->cell_y_m()); }
};

/// A point that stays on the surface while the grip is below it, as close to the grip as friction
/// allows (after D. Ruspini, K. Kolarov and O. Khatib, The haptic display of complex graphical
/// environments, SIGGRAPH 1997). A spring between the two generates the contact force.
///
/// A step of the proxy never lengthens that spring: a step along the tangent plane is accepted only
/// if it ends closer to the grip; otherwise half the step is tried. Steps therefore store no
/// energy, unlike in methods that only follow the tangent plane, in which the proxy climbs at
/// creases.
///
/// A surface can jump because of a cut, because playback starts with the grip below the surface, or
/// because the surface moves faster than kFastest_m_s. The surface is then shifted to the grip and
/// moves to its true height at kRise_m_s, so cuts need not be signalled.
class Proxy {
 public:
  /// The coefficient of kinetic friction of most surfaces, as a fraction of the static one.
  static constexpr double kKineticFriction = 0.8;
  static constexpr double kFastest_m_s = 0.2;  ///< of a surface in contact
  static constexpr double kRise_m_s = 0.04;
  /// The rise reaches kRise_m_s within 0.1 s. Starting at full speed would throw a lightly held
  /// grip up 40 % faster.
  static constexpr double kRise_m_s2 = 0.4;
  static constexpr int kMostSteps = 8;  ///< of half a cell each, in a tick

  /// Performs one tick, `dt_s` > 0 after the last one. `grip_m` is in the device frame. Neither
  /// allocates nor throws. A non-finite grip position ends the contact.
  void move(const MovingRelief& surface, double friction, const Eigen::Vector3d& grip_m,
            double dt_s) noexcept;

  bool touching() const noexcept { return touching_; }
  bool sliding() const noexcept { return sliding_; }
  /// On the surface while touching; otherwise the grip position.
  const Eigen::Vector3d& position_m() const noexcept { return position_m_; }
  /// Surface normal at the proxy, towards the viewer. Valid only while touching.
  const Eigen::Vector3d& normal() const noexcept { return normal_; }
  /// How far the surface is shifted now: > 0 above its true height, < 0 below that.
  double shift_m() const noexcept { return shift_m_; }
  /// Change of the squared distance between proxy and grip in this tick that is due to the motion
  /// of the surface: 2 / stiffness times the energy which that motion put into the spring.
  double stretched_m2() const noexcept { return stretched_m2_; }

  /// Discards all state after the pose was lost: the next position says nothing about the motion.
  void reset() noexcept { *this = {}; }

 private:
  double settled_m(double dt_s) noexcept;
  void carry(const MovingRelief& surface, double shift_m, const Eigen::Vector3d& grip_m,
             double dt_s) noexcept;
  void enter(const MovingRelief& surface, double shift_m, const Eigen::Vector3d& grip_m,
             double dt_s) noexcept;
  void walk(const MovingRelief& surface, double friction, const Eigen::Vector3d& grip_m) noexcept;
  bool step(const MovingRelief& surface, const Eigen::Vector3d& step_m,
            const Eigen::Vector3d& grip_m) noexcept;
  void lose_contact(const Eigen::Vector3d& grip_m) noexcept;

  bool touching_ = false;
  bool sliding_ = false;
  bool started_ = false;
  double shift_m_ = 0;
  double rise_m_s_ = 0;
  double stretched_m2_ = 0;
  Eigen::Vector3d position_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d last_grip_m_ = Eigen::Vector3d::Zero();
};

}  // namespace spidar::touch
