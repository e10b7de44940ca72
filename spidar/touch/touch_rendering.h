// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What the grip touches in the frame that is on the screen.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "core/api.h"
#include "core/touch/contact_force.h"
#include "spidar/touch/touch_mailbox.h"

namespace spidar {

/// The contact in one tick.
struct Contact {
  bool has_surface = false;  ///< there is something that could be touched
  bool touching = false;
  double depth_m = 0;  ///< of the grip below the surface, along its normal; 0 unless touching
  /// The point of the surface that is touched, device frame; 0 unless touching.
  Eigen::Vector3d proxy_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< on the grip, device frame
};

/// Follows the frames of a mailbox by running time and renders the contact with what is between
/// two of them. One thread; neither allocates nor throws.
///
/// From the moment when the next frame is known the surface goes to it along its displacement, and
/// is there when that frame is due; a frame that is known late or too late is met kShortest_ns
/// later (or after the interval between the two, where that is shorter). The last frame holds for
/// as long as nothing follows. What does not follow the frame before it appears when it is due;
/// TouchProxy raises it slowly from where the grip is. The same is done with a frame that rises
/// under the grip faster than that, its displacement allowed for: a flash, a cut that nobody has
/// noticed, or a motion that was not found.
class SPIDAR_API TouchRendering {
 public:
  static constexpr int64_t kShortest_ns = 15'000'000;
  /// After a longer pause between two ticks the grip counts as a new one.
  static constexpr double kLongestTick_s = 0.01;
  /// Another stiffness is reached at this speed, so that setting it is no knock.
  static constexpr double kStiffening_N_m_s = 1000;

  /// A tick `dt_s` after the last. `running_ns`: what is on the screen; `grip_m`: device frame.
  Contact tick(TouchMailbox& mailbox, int64_t running_ns, const Eigen::Vector3d& grip_m,
               double dt_s) noexcept;

  /// What the safety chain lets through of the force, both above 0; unlimited at first. The contact
  /// gives no more energy back than it took only if it knows these limits.
  void set_limits(double max_force_N, double max_slew_N_s) noexcept {
    max_force_N_ = max_force_N;
    max_slew_N_s_ = max_slew_N_s;
  }
  /// What else is wanted in the next tick, which shares those limits.
  void set_beside(const Eigen::Vector3d& force_N) noexcept { beside_N_ = force_N; }

  /// A tick in which nothing is to be touched: nothing plays, or it is not known where the grip is.
  void rest(TouchMailbox& mailbox) noexcept;

 private:
  void drop_forgotten(TouchMailbox& mailbox) noexcept;
  const TouchFrame* frame(const TouchMailbox& mailbox, size_t nth) const noexcept;
  void advance(TouchMailbox& mailbox, int64_t running_ns) noexcept;
  double share_of_next(int64_t running_ns) const noexcept;
  bool jumps(const MovingRelief& surface, const Eigen::Vector2d& place_m) const noexcept;

  uint32_t generation_ = 0;
  bool reached_ = false;   ///< the oldest frame of the mailbox was due
  bool leads_on_ = false;  ///< the way to the frame after it has begun, by the two times below
  bool jumped_ = false;    ///< but does not lead the surface: the next frame has to be waited for
  int64_t from_ns_ = 0;
  int64_t to_ns_ = 0;
  int64_t reached_ns_ = 0;
  double stiffness_N_m_ = 0;  ///< 0: none yet
  double max_force_N_ = ContactSettings{}.max_force_N;
  double max_slew_N_s_ = ContactSettings{}.max_slew_N_s;
  Eigen::Vector3d beside_N_ = Eigen::Vector3d::Zero();
  ContactForce contact_;
};

}  // namespace spidar
