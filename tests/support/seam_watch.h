// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <string>

#include "core/grip/string_geometry.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/profiles/profile.h"

namespace spidar::test {

/// Checks conditions that always hold between the loop and the device, in every tick from outside:
/// the volts for the motors, and their effect on the real grip. The first violation fails the test
/// and names the tick.
class SeamWatch {
 public:
  /// `real` is the true geometry and zero, not those that the loop assumes.
  explicit SeamWatch(const Profile& real);

  struct Tick {
    StringVector told_N = StringVector::Zero();  ///< from the volts of this tick
    bool acknowledged = false;
    double dt_s = 0;        ///< since the tick before
    double size_N = 0;      ///< the largest permitted wrench, torque divided by the grip radius
    bool brakes = false;    ///< tensions may change at once, but not to push
    bool sees = true;       ///< the loop knows the motion of the real grip, so that it is judged
    bool resting = false;   ///< at least 50 ms after the last due wrench, or a brake
    bool released = false;  ///< the motors must be off
    FeltState felt;         ///< what acts on the grip
  };

  /// `where` is printed on failure.
  void check(const Tick& tick, const std::string& where);

  /// Tells that the device was closed or opened: the motors are at zero.
  void reset() { told_N_.setZero(); }

  bool failed() const { return failed_; }

  /// The largest values, for a table.
  struct Largest {
    double resting_force_N = 0;  ///< on the real grip
    double resting_excess = 0;   ///< its part above the force of the minimum tensions there
    double playing_force_N = 0;  ///< on the real grip
    double step_N = 0;           ///< change of a string's tension in a tick
    double stop_energy_J = 0;    ///< of the strings at the grip, from a stop to rest
    uint64_t resting_ticks = 0;
    uint64_t playing_ticks = 0;
  };
  const Largest& largest() const { return largest_; }

  /// Tells that the wrench has ended: counts the work until rest from here.
  void stop() {
    stopping_ = true;
    stop_energy_J_ = 0;
  }

 private:
  double force_N(const Pose& pose, const StringVector& tension_N) const;
  bool never_pushes(const Tick& tick, double passed_s) const;
  void fail(const Tick& tick, const std::string& what, const std::string& where);

  const Profile real_;
  const StringVector least_N_;
  const StringVector most_N_;
  StringVector told_N_ = StringVector::Zero();  ///< the last acknowledged ones, …
  double unanswered_s_ = 0;                     ///< … and how long ago that was
  bool stopping_ = false;
  double stop_energy_J_ = 0;
  bool failed_ = false;
  Largest largest_;
};

}  // namespace spidar::test
