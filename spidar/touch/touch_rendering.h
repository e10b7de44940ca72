// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Renders the contact of the grip with the frame that is on the screen.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "core/touch/contact_force.h"
#include "spidar/touch/shake_watch.h"
#include "spidar/touch/touch_mailbox.h"

namespace spidar {

/// State of the contact in one tick.
struct Contact {
  bool has_surface = false;  ///< the current frame can be touched
  bool touching = false;
  double depth_m = 0;  ///< penetration of the grip along the surface normal; 0 unless touching
  /// The touched point of the surface, device frame; 0 unless touching.
  Eigen::Vector3d proxy_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< on the grip, device frame
  /// Share of the stiffness that is left after shaking, see ShakeWatch.
  double stiffness_share = 1;
};

/// Follows the frames of a mailbox by running time and renders the contact with the surface
/// interpolated between two frames. For one thread; neither allocates nor throws.
///
/// As soon as the next frame is known, the surface moves to it along its displacement and reaches
/// it when that frame is due. If the frame arrives late, the transition takes at least
/// kShortest_ns, or the interval between the two frames if that is shorter. The last frame stays
/// until another one follows. A frame that does not continue the previous one (`follows` is false)
/// appears when it is due, and TouchProxy raises it slowly from the grip. The same applies to a
/// frame that rises under the grip faster than kRise_m_s after compensation of its displacement, as
/// with a flash, an undetected cut, or an undetected motion.
class TouchRendering {
 public:
  static constexpr int64_t kShortest_ns = 15'000'000;
  /// A longer pause between two ticks resets the contact.
  static constexpr double kLongestTick_s = 0.01;
  /// Rate at which the stiffness approaches a new setting, so that a change causes no knock.
  static constexpr double kStiffening_N_m_s = 1000;

  /// Renders a tick `dt_s` after the last. `running_ns` is the running time of the frame on the
  /// screen; `grip_m` is in the device frame.
  Contact tick(TouchMailbox& mailbox, int64_t running_ns, const Eigen::Vector3d& grip_m,
               double dt_s) noexcept;

  /// Sets the limits of the safety chain, both above 0. Initially the defaults of ContactSettings
  /// apply. The contact stays passive only if these limits are correct.
  void set_limits(double max_force_N, double max_slew_N_s) noexcept {
    max_force_N_ = max_force_N;
    max_slew_N_s_ = max_slew_N_s;
  }
  /// Sets the other force of the next tick, which shares these limits.
  void set_beside(const Eigen::Vector3d& force_N) noexcept { beside_N_ = force_N; }

  /// A tick without contact, because nothing is playing or the pose of the grip is unknown.
  void rest(TouchMailbox& mailbox) noexcept;

 private:
  void drop_forgotten(TouchMailbox& mailbox) noexcept;
  const TouchFrame* frame(const TouchMailbox& mailbox, size_t nth) const noexcept;
  void advance(TouchMailbox& mailbox, int64_t running_ns) noexcept;
  double share_of_next(int64_t running_ns) const noexcept;
  bool jumps(const MovingRelief& surface, const Eigen::Vector2d& place_m) const noexcept;

  uint32_t generation_ = 0;
  bool reached_ = false;   ///< the oldest frame of the mailbox has become due
  bool leads_on_ = false;  ///< the transition to the next frame, from_ns_ to to_ns_, has begun
  bool jumped_ = false;    ///< a jump: the current surface stays until the next frame is due
  int64_t from_ns_ = 0;
  int64_t to_ns_ = 0;
  int64_t reached_ns_ = 0;
  double stiffness_N_m_ = 0;  ///< 0: not yet set
  double max_force_N_ = ContactSettings{}.max_force_N;
  double max_slew_N_s_ = ContactSettings{}.max_slew_N_s;
  Eigen::Vector3d beside_N_ = Eigen::Vector3d::Zero();
  ContactForce contact_;
  ShakeWatch shake_watch_;
};

}  // namespace spidar
