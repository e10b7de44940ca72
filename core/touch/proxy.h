// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The point of a surface that a grip touches.
#pragma once

#include <Eigen/Core>

#include "core/api.h"
#include "core/touch/moving_relief.h"

namespace spidar {

/// Coulomb friction: what holds before it slides, and then. 0 ≤ dynamic ≤ fixed.
struct Friction {
  double fixed = 0;    ///< μs
  double dynamic = 0;  ///< μd
};

/// A point that stays on the surface while the grip is inside, as near to it as friction lets it
/// come (after D. Ruspini, K. Kolarov and O. Khatib, The haptic display of complex graphical
/// environments, SIGGRAPH 1997). A spring between the two is the force of the contact.
///
/// The proxy's own move never makes that spring longer: a step along the tangent plane is taken
/// only when it ends nearer to the grip, else half of it is tried. So the move stores no energy.
/// Walks that only follow the tangent do, where they climb on a crease.
///
/// A surface that jumps, because the film cuts, because playing starts with the grip inside of it,
/// or because it moves faster than kFastest_m_s, is shifted to where the grip is and comes to its
/// place at kRise_m_s. So nothing has to be told of a cut.
class SPIDAR_API TouchProxy {
 public:
  static constexpr double kFastest_m_s = 0.2;  ///< of a surface that is touched
  static constexpr double kRise_m_s = 0.04;
  /// A rise gets as fast as that within 0.1 s. Begun at full speed, it would throw a lightly held
  /// grip up 40 % faster.
  static constexpr double kRise_m_s2 = 0.4;
  static constexpr int kMostSteps = 8;  ///< of half a cell each, in a tick

  /// One tick, `dt_s` > 0 after the last. `grip_m` in the device frame. Neither allocates nor
  /// throws. A grip that is not finite touches nothing.
  void move(const MovingRelief& surface, const Friction& friction, const Eigen::Vector3d& grip_m,
            double dt_s) noexcept;

  bool touching() const noexcept { return touching_; }
  bool sliding() const noexcept { return sliding_; }
  /// On the surface; the grip itself where it does not touch.
  const Eigen::Vector3d& position_m() const noexcept { return position_m_; }
  /// Of the surface at the proxy, towards the viewer. Only while touching.
  const Eigen::Vector3d& normal() const noexcept { return normal_; }
  /// How much higher (> 0) or lower the surface is held than it is.
  double shift_m() const noexcept { return shift_m_; }
  /// By how much the surface's own move has changed the squared distance between proxy and grip in
  /// this tick: 2 / stiffness times the energy that it has put into the spring.
  double stretched_m2() const noexcept { return stretched_m2_; }

  /// The pose was lost or a new grip taken: its next place says nothing about how it moved.
  void reset() noexcept { *this = {}; }

 private:
  double settled_m(double dt_s) noexcept;
  void carry(const MovingRelief& surface, double shift_m, const Eigen::Vector3d& grip_m,
             double dt_s) noexcept;
  void enter(const MovingRelief& surface, double shift_m, const Eigen::Vector3d& grip_m,
             double dt_s) noexcept;
  void walk(const MovingRelief& surface, const Friction& friction,
            const Eigen::Vector3d& grip_m) noexcept;
  bool step(const MovingRelief& surface, const Eigen::Vector3d& way_m,
            const Eigen::Vector3d& grip_m) noexcept;
  void leave(const Eigen::Vector3d& grip_m) noexcept;

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

}  // namespace spidar
