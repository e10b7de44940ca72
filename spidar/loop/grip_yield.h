// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>

#include <Eigen/Core>

#include "spidar/grip/grip_motion.h"
#include "spidar/loop/brake_table.h"

namespace spidar::brake {

/// Distinguishes a hand that withstands a force from a grip that yields. Compares the displacement
/// of the grip with the force on it, both smoothed, since begin().
///
/// A grip that yields further than a hand would allow follows the force too slowly for its speed to
/// show, and stores energy in whatever holds it: 125 mJ at 3 N and 36 N/m, which throw 50 g at
/// 2 m/s when a film reverses its force. Where the strings at rest balance the force, they store
/// the energy.
class GripYield {
 public:
  /// Restarts the comparison at the position of the next update().
  void begin() noexcept { has_begun_ = is_balanced_ = false; }

  /// Adds the position and velocity of the grip, `dt_s` after the last call, the force of the
  /// strings, and its part `rest_N` that they exert at rest. `is_whole`: the brake withholds
  /// nothing.
  void update(const Eigen::Vector3d& position_m, const Eigen::Vector3d& velocity_m_s,
              const Eigen::Vector3d& strings_N, const Eigen::Vector3d& rest_N, bool is_whole,
              double dt_s) noexcept {
    if (!has_begun_) begin_at(position_m);
    const double fraction = fraction_passed(dt_s, kYieldTime_s);
    const Eigen::Vector3d moved_m = position_m - from_m_;
    gone_m_ += fraction * (moved_m - gone_m_);
    pulled_N_ += fraction * (strings_N - pulled_N_);
    const bool is_thrown = velocity_m_s.dot(moved_m) < 0 && stores_at(moved_m, rest_N);
    // An unheld grip follows a force that rises slowly to where the strings at rest balance it.
    is_balanced_ =
        !is_withstood() && pulled_N_.norm() <= kTellingForce_N && -rest_N.dot(moved_m) > kThrows_J;
    stores_s_ = has_yielded(is_whole) || is_thrown || is_balanced_ ? kStored_s : stores_s_ - dt_s;
    film_N_ += fraction * (strings_N - rest_N - film_N_);
    swung_J_ =
        std::max(0.5 * film_N_.dot(gone_m_), (1 - fraction_passed(dt_s, kStored_s)) * swung_J_);
    count_withstood(dt_s);
  }

  /// Whether a hand holds the grip: it has withstood the film for kWithstands_s.
  bool is_withstood() const noexcept { return withstood_s_ >= kWithstands_s; }

  /// Whether the grip has yielded, as no held grip does. While the whole wrench passes, only a grip
  /// that moves fast along the force counts.
  bool yields(const Eigen::Vector3d& velocity_m_s, bool is_whole) const noexcept {
    if (!has_yielded(is_whole)) return false;
    if (!is_whole) return true;
    const double speed_m_s = velocity_m_s.norm();
    return speed_m_s > kThrown_m_s &&
           velocity_m_s.dot(pulled_N_) > kAligned * speed_m_s * pulled_N_.norm();
  }

  /// Whether the strings at rest balance the force, and store enough energy to throw the grip.
  bool is_balanced() const noexcept { return is_balanced_; }
  /// Whether the grip may have stored energy that returns with the film's next force.
  bool stores_energy() const noexcept { return stores_s_ > 0; }
  /// The energy that a hand may return after yielding to the film; decays over time.
  double swung_J() const noexcept { return swung_J_; }

 private:
  void begin_at(const Eigen::Vector3d& position_m) noexcept {
    *this = {};
    has_begun_ = true;
    from_m_ = position_m;
  }
  /// Uses the film's force: the total force is zero where the strings at rest balance the film.
  void count_withstood(double dt_s) noexcept {
    const double force_N = film_N_.norm();
    if (force_N < kFirmForce_N) return;
    const bool is_firm = kFirmHand_N_m * film_N_.dot(gone_m_) < force_N * force_N;
    withstood_s_ = is_firm ? withstood_s_ + dt_s : 0;
  }
  /// Whether a grip that moved by `moved_m` has followed the force further than a hand would allow.
  bool is_loose(const Eigen::Vector3d& moved_m) const noexcept {
    const double force_N = pulled_N_.norm();
    if (!(force_N > kTellingForce_N)) return false;
    const double along_m = pulled_N_.dot(moved_m) / force_N;
    return along_m >= kMinYield_m && kLooseHand_N_m * along_m >= force_N;
  }
  /// While the whole wrench passes, the grip must also have moved far, and no hand has withstood a
  /// force.
  bool has_yielded(bool is_whole) const noexcept {
    return is_loose(gone_m_) && (!is_whole || (!is_withstood() && gone_m_.norm() > kThrown_m));
  }
  /// Takes the unsmoothed displacement, on which the energy of a spring depends: at 0.5 m/s, the
  /// smoothed one lags by 25 mm. The work against the strings at rest is added to the energy of a
  /// loose hand.
  bool stores_at(const Eigen::Vector3d& moved_m, const Eigen::Vector3d& rest_N) const noexcept {
    if (is_withstood() || !is_loose(moved_m)) return false;
    const double twice_J = kLooseHand_N_m * moved_m.squaredNorm() - rest_N.dot(moved_m);
    return twice_J > kLooseHand_N_m * kThrown_m * kThrown_m;
  }

  bool has_begun_ = false;
  Eigen::Vector3d from_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gone_m_ = Eigen::Vector3d::Zero();    ///< displacement from `from_m_`, smoothed
  Eigen::Vector3d pulled_N_ = Eigen::Vector3d::Zero();  ///< force of all tensions, smoothed
  Eigen::Vector3d film_N_ = Eigen::Vector3d::Zero();    ///< force above that at rest, smoothed
  double withstood_s_ = 0;  ///< how long a hand has withstood a force, without a break
  double stores_s_ = 0;     ///< how long the grip still counts as one that has stored energy
  double swung_J_ = 0;
  bool is_balanced_ = false;
};

}  // namespace spidar::brake
