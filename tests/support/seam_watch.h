// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Checks conditions that always hold between the loop and the device, whatever is played or fails.
#pragma once

#include <string>

#include "core/grip/pose.h"
#include "core/grip/string_geometry.h"
#include "spidar/profiles/profile.h"
#include "spidar/simulation/simulated_device.h"

namespace spidar::test {

/// Sees every tick from outside: what the motors were told, and what that is on the real grip. The
/// first breach fails the test, with the tick that it was in.
class SeamWatch {
 public:
  /// `real`: geometry and zero as they are, not as the loop believes them to be.
  explicit SeamWatch(const Profile& real);

  struct Tick {
    StringVector told_N = StringVector::Zero();  ///< by the volts of this tick
    bool acknowledged = false;
    double dt_s = 0;        ///< since the tick before
    double size_N = 0;      ///< largest wrench that the limits allow, torque by the grip radius
    bool resting = false;   ///< 50 ms and more after the last wrench that was to be felt
    bool released = false;  ///< the motors are to be off
    FeltState felt;         ///< what the grip feels
  };

  /// `where` is said when it fails.
  void see(const Tick& tick, const std::string& where);

  /// The device was closed or opened: the motors are at zero.
  void restart() { told_N_.setZero(); }

  bool failed() const { return failed_; }

  /// What was seen, for a table.
  struct Largest {
    double resting_force_N = 0;  ///< on the real grip
    double resting_excess = 0;   ///< of that, over what the least tensions give there
    double playing_force_N = 0;  ///< on the real grip
    double step_N = 0;           ///< of a string in a tick
    double stop_energy_J = 0;    ///< of the strings at the grip, from a stop to rest
    uint64_t resting_ticks = 0;
    uint64_t playing_ticks = 0;
  };
  const Largest& largest() const { return largest_; }

  /// A wrench is not to be felt any more: the work that is done until rest counts.
  void stop() {
    stopping_ = true;
    stop_energy_J_ = 0;
  }

 private:
  double force_N(const Pose& pose, const StringVector& tension_N) const;
  void fail(const Tick& tick, const std::string& what, const std::string& where);

  const Profile real_;
  const StringVector least_N_;
  const StringVector most_N_;
  StringVector told_N_ = StringVector::Zero();  ///< acknowledged last
  bool stopping_ = false;
  double stop_energy_J_ = 0;
  bool failed_ = false;
  Largest largest_;
};

}  // namespace spidar::test
