// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What one cycle of the haptic loop saw and did.
#pragma once

#include <cstdint>

#include "core/force/wrench_timeline.h"
#include "core/grip/pose.h"
#include "core/grip/string_geometry.h"
#include "core/wrench.h"
#include "spidar/loop/pose_trouble.h"
#include "spidar/loop/safety.h"
#include "spidar/touch/touch_rendering.h"

namespace spidar {

enum class DeviceState {
  kClosed,
  kOpening,  ///< tensions ramp up to rest
  kRunning,
  kClosing,  ///< wrench and tensions ramp down to zero
  kIdle,     ///< nothing to be felt for a long time: the motors are off
  kLost,     ///< does not answer; tried again
};

/// "closed", "opening", "running", "closing", "idle", "lost".
constexpr const char* to_string(DeviceState state) noexcept {
  switch (state) {
    case DeviceState::kClosed:
      return "closed";
    case DeviceState::kOpening:
      return "opening";
    case DeviceState::kRunning:
      return "running";
    case DeviceState::kClosing:
      return "closing";
    case DeviceState::kIdle:
      return "idle";
    case DeviceState::kLost:
      return "lost";
  }
  return "unknown";
}

/// "nothing", "exact", "interpolated", "held", "expired".
constexpr const char* to_string(Found found) noexcept {
  switch (found) {
    case Found::kNothing:
      return "nothing";
    case Found::kExact:
      return "exact";
    case Found::kInterpolated:
      return "interpolated";
    case Found::kHeld:
      return "held";
    case Found::kExpired:
      return "expired";
  }
  return "unknown";
}

/// One tick, as it was. Also the row of the haptic trace.
struct TickRecord {
  uint64_t tick = 0;             ///< 1 for the first after open()
  int64_t monotonic_ns = 0;      ///< CLOCK_MONOTONIC at which it began
  int64_t lateness_ns = 0;       ///< behind the deadline
  int64_t running_ns = 0;        ///< running time on the screen; 0 while not playing
  int64_t frame_ns = INT64_MIN;  ///< running time of the frame whose wrench was reached last
  Found found = Found::kNothing;
  /// From the timeline, and from what is touched; zero while not playing.
  Wrench wanted;
  /// After finite, limit, slew and stale. Not acknowledged: that of the last tick that was,
  /// limited.
  Wrench commanded;
  /// W · tension, what the strings can do of it; W is that of `pose`, also where it is not trusted.
  Wrench delivered;
  StringVector tension_N = StringVector::Zero();  ///< as `commanded`
  bool acknowledged = true;                       ///< the device has answered
  Pose pose;                                      ///< from the newest good reading
  double pose_residual_m = 0;
  int faulty_string = -1;  ///< whose length fits no pose that the others agree on; −1 when all fit
  DeviceState device = DeviceState::kClosed;
  bool playing = false;
  double max_force_N = 0;  ///< limits that held
  double max_torque_Nm = 0;
  Contact contact;  ///< with what can be touched; its force is part of `wanted`
};

/// Numbers since the loop was opened.
struct LoopCounters {
  uint64_t ticks = 0;
  uint64_t overruns = 0;          ///< ticks that began more than one period late
  uint64_t missed_deadlines = 0;  ///< deadlines left out because of that
  uint64_t exchange_errors = 0;
  uint64_t pose_errors = 0;
  uint64_t string_faults = 0;      ///< times that a string became faulty, or another one did
  uint64_t rejected_wrenches = 0;  ///< not finite
  uint64_t refused_wrenches = 0;   ///< time not after that of the one before
  uint64_t times_lost = 0;
  uint64_t held_back_ticks =
      0;  ///< in which less than wanted was asked of the strings, see held_back
};

struct LoopSnapshot {
  TickRecord last;
  LoopCounters counters;
  SafetyLimits limits;  ///< that held in the last tick
  PoseTrouble pose_trouble = PoseTrouble::kNotYet;
  int64_t untrusted_ns = 0;  ///< for how long the pose has not been trusted; 0 while it is
  int64_t unfelt_ns = 0;  ///< for how long the command has been too weak to feel; 0 while it is not
  double motor_heat = 0;  ///< of the warmest motor, see MotorHeat
  /// Less force than wanted: a string is out, or a motor is warm.
  bool held_back = false;
};

}  // namespace spidar
