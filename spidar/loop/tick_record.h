// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>

#include "core/force/wrench_timeline.h"
#include "core/grip/string_geometry.h"
#include "core/wrench.h"
#include "spidar/grip/grip.h"
#include "spidar/grip/grip_motion.h"
#include "spidar/grip/pose_trust.h"
#include "spidar/limits/vibration_budget.h"
#include "spidar/touch/touch_rendering.h"

namespace spidar {

enum class DeviceState {
  kClosed,
  kOpening,  ///< tensions ramp up to rest
  kRunning,
  kClosing,  ///< wrench and tensions ramp down to zero
  kIdle,     ///< no force has been wanted for a long time: the motors are off
  kLost,     ///< does not answer; the loop tries to reopen it
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

/// Inputs and results of one cycle of the haptic loop, and the row of the haptic trace. In a tick
/// in which the device was lost, the report of the grip has the last pose, and neither wrench nor
/// tensions.
struct TickRecord : GripReport {
  uint64_t tick = 0;             ///< 1 for the first after open()
  int64_t monotonic_ns = 0;      ///< CLOCK_MONOTONIC at its beginning
  int64_t lateness_ns = 0;       ///< behind the deadline
  int64_t running_ns = 0;        ///< running time on the screen; 0 while not playing
  int64_t frame_ns = INT64_MIN;  ///< running time of the last frame whose wrench was reached
  Found found = Found::kNothing;
  /// The sum of the timeline's wrench, the contact force and the callback's wrench; zero without
  /// any.
  Wrench wanted;
  /// The wrench after the steps of WrenchChain. If not acknowledged, the one of the last
  /// acknowledged tick, within the limits of this one.
  Wrench commanded;
  bool acknowledged = true;  ///< whether the device has answered
  GripVelocity velocity;  ///< GripMotion::kLag_s behind `pose`; zero while no pose follows another
  bool brakes = false;    ///< see GripCommand
  bool held = true;       ///< false: nobody holds the grip, and the wrench is at rest or returning
  DeviceState device = DeviceState::kClosed;
  bool playing = false;
  bool called_back = false;  ///< whether the application's callback was called
  double max_force_N = 0;    ///< limits in effect
  double max_torque_Nm = 0;
  touch::Contact contact;  ///< with the touched surface; its force is part of `wanted`
};

/// The forces of one tick, for a plot.
struct ForceTick {
  int64_t monotonic_ns = 0;
  Eigen::Vector3d wanted_N = Eigen::Vector3d::Zero();
  Eigen::Vector3d delivered_N = Eigen::Vector3d::Zero();
};

/// Counts since the loop was opened.
struct LoopCounters {
  uint64_t ticks = 0;
  uint64_t overruns = 0;          ///< ticks that began more than one period late
  uint64_t missed_deadlines = 0;  ///< deadlines skipped because of overruns
  /// Ticks of playback without a force, because a frame was over and the next one had not come yet.
  /// They count when the next frame comes, so that the end of a film is no gap.
  uint64_t gap_ticks = 0;
  uint64_t exchange_errors = 0;
  uint64_t pose_errors = 0;
  uint64_t string_faults = 0;      ///< how often a string was newly found faulty
  uint64_t rejected_wrenches = 0;  ///< not finite
  uint64_t refused_wrenches = 0;   ///< whose time is not later than that of the previous one
  uint64_t times_lost = 0;
  uint64_t held_back_ticks = 0;  ///< ticks with less than the commanded wrench, see GripReport
};

struct LoopSnapshot {
  TickRecord last;
  LoopCounters counters;
  SafetyLimits limits;       ///< in effect in the last tick
  int64_t untrusted_ns = 0;  ///< how long the pose has not been trusted; 0 while it is
  int64_t unfelt_ns = 0;  ///< for how long the command has been too weak to feel; 0 while it is not
  VibrationBudget::State vibration{};
  /// How much later than its frame the device renders a wrench, because the film is not known as
  /// far ahead as the device lags.
  int64_t late_ns = 0;
  /// How much later than its motion the wrench of the newest frame came, because the frame became
  /// known too late.
  int64_t motion_late_ns = 0;
};

}  // namespace spidar
