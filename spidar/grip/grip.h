// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The interface between the haptic loop and the grip of a device: a wrench out, a pose in.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "core/default_limits.h"
#include "core/grip/string_geometry.h"
#include "core/wrench.h"
#include "spidar/device.h"
#include "spidar/grip/grip_motion.h"
#include "spidar/grip/pose_trust.h"
#include "spidar/limits/released_turn.h"
#include "spidar/limits/safety_limits.h"

namespace spidar {

struct GripAbilities {
  /// The axes of the force that are rendered: right, up, towards the viewer.
  std::array<bool, 3> force{true, true, true};

  bool torque = true;
  /// If false, only the magnitude of the force is rendered, in these axes.
  bool direction = true;
  std::array<bool, 3> position{true, true, true};  ///< the axes that are measured
  double largest_force_N = 0;                      ///< in every direction that is rendered
  int rate_Hz = 1000;                              ///< forces a second, at most
  int buttons = 0;                                 ///< at most 32
  /// How far the grip moves from its middle to each side; 0: as far as in the profile.
  std::array<double, 3> half_workspace_m{};

  /// Whether the grip can touch a picture, whose depth is rendered along the third axis.
  bool can_touch() const noexcept { return force[2] && position[2]; }
  /// Whether the grip can point at a position of a picture.
  bool can_point() const noexcept { return position[0] || position[1]; }
  /// The largest force limit: the largest force of the grip, and at least the default.
  double max_limit_N() const noexcept { return std::max(kDefaultForce_N, largest_force_N); }
};

/// The properties of a grip that do not change while it is open.
struct GripTraits {
  bool has_strings = true;  ///< whether the strings of a profile pull the grip
  bool can_fly = true;      ///< whether the wrench can throw a released grip
  double radius_m = 0;      ///< radius at which a torque counts as a force; 0: torques do not count
  double drive_lag_s = 0;   ///< lag from a command to its force
  GripBody body{};          ///< mass and inertia of a grip that turns

  /// The largest force limit, whoever sets it, with answers that take `late_s` longer than a tick:
  /// a released grip must not be thrown.
  double most_force_N(double late_s = 0) const noexcept {
    return can_fly ? released_force_N(drive_lag_s, late_s)
                   : std::numeric_limits<double>::infinity();
  }
  /// The largest torque limit, in the same way.
  double most_torque_Nm(double late_s = 0) const noexcept {
    return can_fly ? released_torque_Nm(body, radius_m, drive_lag_s, late_s)
                   : std::numeric_limits<double>::infinity();
  }
};

/// The command that a grip receives in a tick.
struct GripCommand {
  Wrench wrench;  ///< on the hand, within the limits; only the brake exceeds the rate limits
  /// Whether the brake acts, see GripBrake: a force that does not brake the motion fades and
  /// returns at once, and damping begins at once. Tensions that push rise no faster than otherwise.
  bool brakes = false;
  /// Whether a wrench is wanted and the pose is known. Otherwise the wrench is ramping to zero.
  bool fresh = false;
  /// The fraction of every tension and force, 0 … 1, which rises after opening and falls before
  /// closing. At 0 the motors are off.
  double power = 0;
  SafetyLimits limits;
  double dt_s = 0;  ///< since the last tick
  int64_t now_ns = 0;
};

/// The state of a grip after a tick, as far as it is known. The members before `pose` result from
/// the last command.
struct GripReport {
  /// The wrench that the hand gets, computed for `pose` even if the pose is no longer known.
  Wrench delivered;
  StringVector tension_N = StringVector::Zero();  ///< commanded; zero for a grip without strings
  bool held_back = false;  ///< whether a left-out string or a warm motor reduces the wrench

  Pose pose;             ///< from the newest good reading
  uint32_t buttons = 0;  ///< the pressed ones; the first button is the lowest bit
  PoseFault pose_fault = PoseFault::kNotYet;
  double pose_residual_m = 0;
  int faulty_string = -1;  ///< the string whose length contradicts the others; −1 if all fit
  double motor_heat = 0;   ///< heat of the warmest motor, see MotorHeat
};

/// A GripReport with the values that only the loop needs.
struct GripReading : GripReport {
  Wrench at_rest;              ///< the part of `delivered` that strings exert without a command
  double stored_J = 0;         ///< energy that the strings at rest return on the way to the centre
  GripMotion motion;           ///< of the poses, also outside the frame; at rest without poses
  uint64_t pose_errors = 0;    ///< answers without a pose, since the grip was constructed
  int64_t lag_ns = 0;          ///< lag from a command to its effect, if the device reports it
  uint64_t string_faults = 0;  ///< how often a string was newly found faulty

  bool knows_pose() const noexcept { return pose_fault == PoseFault::kNone; }
};

/// The grip that a hand holds, with the device behind it. This class protects the device and
/// everything between device and hand; HapticLoop, above it, protects the hand (docs/safety.md).
class Grip : public Openable {
 public:
  /// `device` outlives the grip, or belongs to it.
  explicit Grip(Openable& device) : Openable(device.name()), device_(device) {}

  /// Call this in each tick, with the time since the last one, s; also while the device is lost.
  virtual void advance(double) noexcept {}

  /// Ends trust in a pose that is too old. Call this before the wrench of a tick is computed.
  virtual void check_age(int64_t now_ns) noexcept = 0;

  /// Performs one cycle at 1 kHz: no allocation, no lock, no exception. If the result is not kNone,
  /// the device may have received nothing: the next command continues from the last one that was
  /// answered. The pose can become known only while `command.wrench` is zero.
  virtual LinkFault exchange(const GripCommand& command) noexcept = 0;

  /// Returns the reading after the last call.
  virtual const GripReading& reading() const noexcept = 0;

  void close() noexcept final { device_.close(); }
  std::string description() const final { return device_.description(); }
  LinkHealth health() const noexcept final { return device_.health(); }

  virtual const GripTraits& traits() const noexcept = 0;

  /// Until open(), these are the abilities of most devices of this kind. Any thread.
  virtual GripAbilities abilities() const noexcept = 0;
  /// Returns a message for the user about a device that works, but not as it should; empty if all
  /// is well. Any thread.
  virtual std::string warning() const { return {}; }

 private:
  Openable& device_;
};

}  // namespace spidar
