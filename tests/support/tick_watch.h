// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Checks conditions that hold in every tick of the haptic loop, whatever is played.
#pragma once

#include <string>

#include "spidar/loop/haptic_loop.h"

namespace spidar::test {

/// Sees every tick of a test and fails it at the first that breaks one of the promises: force and
/// torque never above their limits; their changes never faster than the slew limit allows; rest,
/// exactly, 50 ms after the last wrench that was to be felt (of time in which the device answered);
/// and the same 50 ms after the newest frame has become 100 ms old, by CLOCK_MONOTONIC or by
/// running time, but for the 40 ms in which the force fades in before the next frame, and for a
/// surface that the grip is in.
class TickWatch {
 public:
  /// Ticks the loop in time, and looks at what came of it.
  TickRecord tick(HapticLoop& loop, int64_t now_ns);

  /// The next tick of a loop, which ran under these limits. Its tick, monotonic_ns, running_ns,
  /// frame_ns, found, playing, device and commanded are looked at.
  void see(const TickRecord& record, const SafetyLimits& limits);

  /// Reads the trace of a loop, which ran under the total limits that it names and the others of
  /// `limits`. Fails where there is none.
  void see_trace(const std::string& path, const SafetyLimits& limits = {});

  uint64_t ticks() const { return ticks_; }
  /// In which there was a force or a torque.
  uint64_t felt() const { return felt_; }
  const TickRecord& last() const { return last_; }

 private:
  void look_at_age(const TickRecord& record, double dt_s);
  void fail(const TickRecord& record, const std::string& what);

  bool failed_ = false;  // one failure says it all
  bool following_ = false;
  TickRecord last_;
  double largest_N_ = 0;  // limits that held once
  double largest_Nm_ = 0;
  double stopped_s_ = 0;
  int64_t newest_frame_ns_ = INT64_MIN;
  int64_t newest_since_ns_ = 0;
  double old_s_ = 0;  // that it has been too old, in ticks that count
  bool fading_in_ = false;
  int64_t fading_in_since_ns_ = 0;
  uint64_t ticks_ = 0;
  uint64_t felt_ = 0;
};

}  // namespace spidar::test
