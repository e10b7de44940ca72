// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "core/touch/height_field.h"

namespace spidar::touch {

/// Interpolates between two reliefs at the fraction s of the time between them, while the picture
/// moves by u:
/// h(p) = (1 − s) before(p − s u) + s after(p + (1 − s) u).
/// An object that moves by u keeps its shape; plain cross-fading would show it twice. The reliefs
/// belong to the caller.
struct MovingRelief {
  const HeightField* before = nullptr;                       ///< must not be null
  const HeightField* after = nullptr;                        ///< null: `before` alone, at rest
  double fraction = 0;                                       ///< s, 0 … 1
  Eigen::Vector2d displacement_m = Eigen::Vector2d::Zero();  ///< u

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

/// A point that stays on the surface while the grip is below the surface, and as close to the grip
/// as friction allows (after D. Ruspini, K. Kolarov and O. Khatib, The haptic display of complex
/// graphical environments, SIGGRAPH 1997). A spring from the proxy to the grip generates the
/// contact force.
///
/// A step of the proxy never lengthens that spring, and therefore stores no energy: a step along
/// the tangent plane is accepted only if it ends closer to the grip; otherwise half the step is
/// tried. If all steps along the tangent plane were accepted, the proxy would climb at creases.
///
/// The surface jumps at a cut, when playback starts with the grip below the surface, and when the
/// surface moves faster than kFastest_m_s. It is then shifted to the grip and moves to its true
/// height at kRise_m_s, so nobody has to announce a cut.
class Proxy {
 public:
  /// The coefficient of kinetic friction of most surfaces, as a fraction of the static one.
  static constexpr double kKineticFriction = 0.8;
  static constexpr double kFastest_m_s = 0.2;  ///< largest speed of a surface in contact
  static constexpr double kRise_m_s = 0.04;    ///< speed of a shifted surface that rises
  /// The acceleration to kRise_m_s, which takes 0.1 s. Starting at full speed would throw a lightly
  /// held grip up 40 % faster.
  static constexpr double kRise_m_s2 = 0.4;
  static constexpr int kMostSteps = 8;  ///< per tick, each of at most half a cell

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
  /// The height that is now added to the surface: negative while the surface rises to its true
  /// height, positive while it falls to it.
  double shift_m() const noexcept { return shift_m_; }
  /// The change of the squared distance between proxy and grip that the motion of the surface
  /// causes in this tick. Half the stiffness times this is the energy which the motion puts into
  /// the spring.
  double stretched_m2() const noexcept { return stretched_m2_; }

  /// Ends the contact and forgets the position of the grip. Call this when the pose is lost,
  /// because the grip may have moved anywhere when the pose is known again.
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
