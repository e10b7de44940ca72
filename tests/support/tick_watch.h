// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>

#include "spidar/loop/haptic_loop.h"

namespace spidar::test {

/// Checks every tick of a test, and fails the test at the first violation of one of these
/// conditions, whatever is played. Force and torque never exceed their limits. Their changes never
/// exceed the slew limit in the time since the device has answered, of which two ticks count for
/// rising values; where the brake acts, the force pushes no harder than the slew limit allows, and
/// is larger only against a fast grip. (SeamWatch judges the torque and the strings; it knows the
/// real motion.) There is exactly no force 50 ms after the last due wrench, unless the brake acts,
/// and 50 ms after the newest frame has become 100 ms old, by CLOCK_MONOTONIC or by running time.
/// The exceptions are the 40 ms in which the force fades in before the next frame, and a surface
/// that the grip touches.
class TickWatch {
 public:
  /// Ticks the loop on time, and checks the result.
  TickRecord tick(HapticLoop& loop, int64_t now_ns);

  /// Checks the next tick of a loop that ran under these limits. Uses tick, monotonic_ns,
  /// running_ns, frame_ns, found, playing, device, acknowledged, brakes, pose, wanted and
  /// commanded.
  void check(const TickRecord& record, const SafetyLimits& limits);

  /// Checks the trace of a loop that ran under the total limits in the trace and the other limits
  /// of `limits`. Fails when there is no trace.
  void check_trace(const std::string& path, const SafetyLimits& limits = {});

  uint64_t ticks() const { return ticks_; }
  /// The number of ticks with a force or a torque.
  uint64_t felt() const { return felt_; }
  const TickRecord& last() const { return last_; }

 private:
  std::string fault_of_brake(const TickRecord& record) const;
  void look_at_age(const TickRecord& record, double dt_s);
  void fail(const TickRecord& record, const std::string& what);

  bool failed_ = false;  // reports only the first failure
  bool following_ = false;
  TickRecord last_;
  GripMotion motion_;
  double largest_N_ = 0;  // the largest limits so far
  double largest_Nm_ = 0;
  double slewed_N_ = 0;      // the most that the force can be before the brake takes a part
  double unanswered_s_ = 0;  // since the last acknowledged tick
  double stopped_s_ = 0;
  int64_t newest_frame_ns_ = INT64_MIN;
  int64_t newest_since_ns_ = 0;
  double old_s_ = 0;  // how long the frame has been too old, in ticks that count
  bool fading_in_ = false;
  int64_t fading_in_since_ns_ = 0;
  uint64_t ticks_ = 0;
  uint64_t felt_ = 0;
};

}  // namespace spidar::test
