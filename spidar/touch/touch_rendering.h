// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Renders the contact of the grip with the frame on the screen. A mailbox passes on the frames.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/touch/contact_force.h"
#include "core/touch/height_field.h"

namespace spidar::touch {

/// The touchable surface of one frame.
struct Surface {
  Surface(double width_m, double height_m)
      : relief(width_m, height_m), texture(width_m, height_m) {}

  int64_t time_ns = 0;       ///< running time at which the frame is shown
  bool has_surface = false;  ///< if false, nothing can be touched from that time on
  bool has_texture = false;  ///< if false, `texture` is not valid
  /// Whether `displacement_m` is the motion since the previously published frame. False after a
  /// cut, a seek, or a frame that was left out, where the motion in between is unknown.
  bool follows = false;
  Eigen::Vector2d displacement_m = Eigen::Vector2d::Zero();
  ContactSettings contact;  ///< valid
  HeightField relief;
  HeightField texture;
  uint32_t generation = 0;  ///< the one passed to begin()
};

/// A wait-free single-producer, single-consumer queue that copies no frames. The writer fills a
/// slot in place and the reader keeps the two frames between which it interpolates, so at least
/// three slots are needed. More slots allow for frames that pass the element long before they are
/// shown, because GStreamer's queues hold some of them before the sink.
class Mailbox {
 public:
  static constexpr size_t kMinSlots = 3;

  /// The picture measures `width_m` × `height_m` in the device frame. Throws std::invalid_argument
  /// unless both are finite and above 0, and `slots` is at least kMinSlots. Allocates 300 kB per
  /// slot; no other method allocates.
  Mailbox(double width_m, double height_m, size_t slots);
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  size_t slots() const noexcept { return frames_.size(); }

  // --- any thread

  /// Makes the reader discard, at its next tick, every frame published or begun before this call.
  void clear() noexcept { generation_.fetch_add(1, std::memory_order_acq_rel); }
  uint32_t generation() const noexcept { return generation_.load(std::memory_order_acquire); }

  // --- writer

  /// Returns the slot to fill, with its old content, or null when none is free. Pass the generation
  /// that was current when processing of the frame began.
  Surface* begin(uint32_t generation) noexcept;
  void publish() noexcept;

  // --- reader

  /// Returns the oldest frame or the `nth` after it, null if there is none. Valid until dropped.
  const Surface* front(size_t nth = 0) const noexcept;
  /// Releases the slot of front(), which must not be null.
  void drop() noexcept { head_.store(head_.load(std::memory_order_relaxed) + 1, kRelease); }

 private:
  static constexpr std::memory_order kRelease = std::memory_order_release;

  std::vector<Surface> frames_;
  // On separate cache lines, to avoid false sharing between writer and reader.
  alignas(64) std::atomic<size_t> head_{0};  ///< number of frames dropped
  alignas(64) std::atomic<size_t> tail_{0};  ///< number of frames published
  alignas(64) std::atomic<uint32_t> generation_{0};
};

/// Detects a surface that is too stiff for the lag of the drives: it shakes a grip that presses on
/// it at 15 to 60 Hz, faster than a hand trembles. The velocity across the surface, minus its slow
/// part, then changes sign at even intervals. A tap has two or three such intervals. While the grip
/// strokes along the surface, the relief itself may shake the grip, so strokes do not count.
class ShakeWatch {
 public:
  static constexpr double kSlowest_Hz = 15;
  static constexpr double kFastest_Hz = 60;
  /// The velocity must reach this between two changes of sign. A force of 0.5 N at 30 Hz moves a
  /// grip of 0.3 kg this fast; the steps of an encoder give errors of 1.5 mm/s.
  static constexpr double kMin_m_s = 0.008;
  static constexpr double kStroke_m_s = 0.05;
  static constexpr int kIntervals = 8;  ///< this many even intervals in a row count as shaking
  /// The fraction of the stiffness that is left after each shaking.
  static constexpr double kLeft = 0.7;
  static constexpr double kMinFraction = 0.1;

  /// Adds a tick in contact, with the velocity of the grip and the unit normal of the surface.
  void update(const Eigen::Vector3d& velocity_m_s, const Eigen::Vector3d& normal,
              double dt_s) noexcept {
    const double across_m_s = velocity_m_s.dot(normal);
    const double along_m_s = (velocity_m_s - across_m_s * normal).norm();
    slow_m_s_ += std::min(1.0, dt_s / kSlow_s) * (across_m_s - slow_m_s_);
    const double shaken_m_s = across_m_s - slow_m_s_;
    since_s_ += dt_s;
    most_m_s_ = std::max(most_m_s_, std::fabs(shaken_m_s));
    if (since_s_ > 0.5 / kSlowest_Hz || along_m_s > kStroke_m_s) intervals_ = 0;
    if ((shaken_m_s > 0) == rises_) return;
    rises_ = !rises_;
    const bool even = since_s_ >= 0.5 / kFastest_Hz && most_m_s_ >= kMin_m_s;
    intervals_ = even ? intervals_ + 1 : 0;
    since_s_ = most_m_s_ = 0;
    if (intervals_ < kIntervals) return;
    intervals_ = 0;
    fraction_ = std::max(kMinFraction, kLeft * fraction_);
  }

  /// The fraction of the stiffness that is left: 1 until the grip has shaken. The fraction does not
  /// rise again, because the lag belongs to the device.
  double fraction() const noexcept { return fraction_; }

 private:
  static constexpr double kSlow_s = 0.02;  ///< 8 Hz

  double slow_m_s_ = 0;
  double most_m_s_ = 0;  ///< the largest speed since the sign changed
  double since_s_ = 0;
  bool rises_ = false;
  int intervals_ = 0;
  double fraction_ = 1;
};

/// The state of the contact in one tick.
struct Contact {
  bool has_surface = false;  ///< whether the current frame can be touched
  bool touching = false;
  double depth_m = 0;  ///< penetration of the grip along the surface normal; 0 unless touching
  /// The touched point of the surface, device frame; 0 unless touching.
  Eigen::Vector3d proxy_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_N = Eigen::Vector3d::Zero();  ///< on the grip, device frame
  /// The fraction of the stiffness that is left after shaking, see ShakeWatch.
  double stiffness_fraction = 1;
};

/// Follows the frames of a mailbox by running time and renders the contact with the surface
/// interpolated between two frames. For one thread; neither allocates nor throws.
///
/// As soon as the next frame is known, the surface moves to it along its displacement and reaches
/// it when that frame is due. If the frame arrives late, the transition takes at least
/// kShortest_ns, or the interval between the two frames if that is shorter. The last frame stays
/// until another one follows. A frame that does not continue the previous one (`follows` is false)
/// appears when it is due, and Proxy raises it slowly from the grip. The same applies to a frame
/// that rises under the grip faster than kRise_m_s after compensation of its displacement, as with
/// a flash, an undetected cut, or an undetected motion.
class Rendering {
 public:
  static constexpr int64_t kShortest_ns = 15'000'000;
  static constexpr double kLongestTick_s = 0.01;
  /// The rate at which the stiffness approaches a new setting, so that a change causes no knock.
  static constexpr double kStiffening_N_m_s = 1000;

  /// Renders a tick `dt_s` after the last. `running_ns` is the running time of the frame on the
  /// screen; `grip_m` is in the device frame.
  Contact tick(Mailbox& mailbox, int64_t running_ns, const Eigen::Vector3d& grip_m,
               double dt_s) noexcept;

  /// Sets the limits of the safety chain, both above 0. Initially the defaults of ContactSettings
  /// apply. The contact stays passive only if these limits are correct.
  void set_limits(double max_force_N, double max_slew_N_s) noexcept {
    max_force_N_ = max_force_N;
    max_slew_N_s_ = max_slew_N_s;
  }
  void set_beside(const Eigen::Vector3d& force_N) noexcept { beside_N_ = force_N; }

  /// Call this after tick(), with the wrench that the device exerts for the contact and the other
  /// force, see touch::EnergyBudget.
  void set_delivered(const Wrench& given, const Eigen::Vector3d& turn_rad) noexcept {
    contact_.set_delivered(given, turn_rad);
  }

  /// Renders a tick without contact, because nothing is playing or the pose of the grip is unknown.
  void tick_without_contact(Mailbox& mailbox) noexcept;

 private:
  void drop_cleared(Mailbox& mailbox) noexcept;
  const Surface* frame(const Mailbox& mailbox, size_t nth) const noexcept;
  void advance(Mailbox& mailbox, int64_t running_ns) noexcept;
  double fraction_of_next(int64_t running_ns) const noexcept;
  bool jumps(const MovingRelief& surface, const Eigen::Vector2d& position_m) const noexcept;

  uint32_t generation_ = 0;
  bool reached_ = false;  ///< whether the oldest frame of the mailbox has become due
  /// Whether the transition to the next frame, from_ns_ to to_ns_, has begun.
  bool leads_on_ = false;
  bool jumped_ = false;  ///< after a jump, the current surface stays until the next frame is due
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

}  // namespace spidar::touch
