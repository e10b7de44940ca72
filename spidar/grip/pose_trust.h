// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace spidar {

enum class PoseFault {
  kNone,
  kNotYet,     ///< too few good poses in a row since the device was opened or the pose was lost
  kNoReading,  ///< the device did not answer
  kNoFit,      ///< the string lengths fit no pose
  kJump,       ///< a pose that a hand could not have reached since the last one
  kOutside,    ///< a pose outside the frame
  kTurned,     ///< a pose that is turned so far that the strings would tangle
  kNotHomed,   ///< encoders have not passed their marks since the device was switched on
  kFrozen,     ///< no counter moves, although the force on the grip has changed
};

/// Returns a text for messages: "the string lengths fit no pose", …
constexpr const char* to_string(PoseFault fault) noexcept {
  switch (fault) {
    case PoseFault::kNone:
      return "none";
    case PoseFault::kNotYet:
      return "too few good readings in a row";
    case PoseFault::kNoReading:
      return "the device does not answer";
    case PoseFault::kNoFit:
      return "the string lengths fit no pose";
    case PoseFault::kJump:
      return "the grip seems to move faster than a hand can";
    case PoseFault::kOutside:
      return "the grip seems to be outside the frame";
    case PoseFault::kTurned:
      return "the grip seems to be turned right round";
    case PoseFault::kNotHomed:
      return "the device does not know its zero: pull the grip all the way out, then push it all "
             "the way in";
    case PoseFault::kFrozen:
      return "no encoder counts, although the force has changed";
  }
  return "unknown";
}

/// Whether the pose of a grip can be trusted. Trust ends after kMaxMisses readings without a good
/// pose and returns after kGoodPoses good poses in a row.
class PoseTrust {
 public:
  /// The number of ticks in a row that may pass without a good pose; they use the previous pose.
  static constexpr int kMaxMisses = 5;
  /// The same limit as a time, for ticks that are late themselves.
  static constexpr int64_t kPoseTimeout_ns = 50'000'000;
  /// The number of good poses in a row before the pose is trusted again.
  static constexpr int kGoodPoses = 20;
  static constexpr double kMaxSpeed_m_s = 10;  ///< no hand is faster
  /// Allows for noise of the pose, and for the time between reading the sensors and the clock.
  static constexpr double kJumpMargin_m = 2e-3;

  /// Whether a grip that has moved by `moved_m` since its newest pose was faster than any hand.
  bool is_jump(double moved_m, int64_t read_ns) const noexcept {
    const double passed_s = 1e-9 * static_cast<double>(read_ns - located_ns_);
    return located_ && moved_m > kMaxSpeed_m_s * passed_s + kJumpMargin_m;
  }
  /// Returns the time at which a pose was read: the device's `read_ns`, or the tick's `now_ns` if
  /// `read_ns` comes from another clock or is older than any trusted pose.
  static int64_t time_of(int64_t read_ns, int64_t now_ns) noexcept {
    return std::abs(read_ns - now_ns) < kPoseTimeout_ns ? read_ns : now_ns;
  }
  /// Call this when a pose, good or not, was read at `read_ns`.
  void locate(int64_t read_ns) noexcept {
    located_ = true;
    located_ns_ = read_ns;
  }
  /// Call this for a good pose. Trust can begin only if `may_trust`; existing trust continues in
  /// any case.
  void succeed(bool may_trust) noexcept {
    misses_ = 0;
    good_poses_ = std::min(good_poses_ + 1, kGoodPoses);
    if (good_poses_ == kGoodPoses && may_trust) trusted_ = true;
  }
  /// Call this when there is no good pose. With `at_once`, trust ends now, because the previous
  /// pose is no longer true either.
  void fail(PoseFault fault, bool at_once = false) noexcept {
    if (at_once) misses_ = kMaxMisses;
    good_poses_ = 0;
    if (++misses_ <= kMaxMisses && trusted_) return;
    trusted_ = false;
    fault_ = fault;
  }
  /// Call this when the device did not answer in a tick.
  void miss(int64_t now_ns) noexcept {
    check_age(now_ns);
    fail(PoseFault::kNoReading);
  }
  /// Ends trust if the newest pose is too old. Call this before the force of a tick is computed.
  void check_age(int64_t now_ns) noexcept {
    if (!trusted_ || now_ns - located_ns_ <= kPoseTimeout_ns) return;
    trusted_ = false;
    good_poses_ = 0;
    fault_ = PoseFault::kNoReading;
  }

  bool trusted() const noexcept { return trusted_; }
  /// Returns kNone while the pose is trusted.
  PoseFault fault() const noexcept { return trusted_ ? PoseFault::kNone : fault_; }
  int64_t located_ns() const noexcept { return located_ns_; }

 private:
  bool trusted_ = false;
  PoseFault fault_ = PoseFault::kNotYet;
  int misses_ = 0;
  int good_poses_ = 0;
  bool located_ = false;
  int64_t located_ns_ = 0;
};

}  // namespace spidar
