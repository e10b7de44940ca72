/// The steps between a wanted wrench and the motors. Order: finite → limit → slew → stale → (tension
/// solver) → tension bounds → D/A range. Each is a small object that can be tested alone.
#pragma once

#include <cstdint>

#include "core/api.h"
#include "core/string_geometry.h"
#include "core/wrench.h"
#include "spidar/device.h"
#include "spidar/profile.h"

namespace spidar {

struct SafetyLimits {
  double max_force_N = 3.0;      ///< of the total force
  double max_torque_Nm = 0.1;    ///< of the total torque
  double max_slew_N_s = 300.0;   ///< full default force in 10 ms
  double max_slew_Nm_s = 10.0;
  double ramp_s = 0.04;          ///< from full to rest and back when commands stop or begin
};

/// Not finite in any part: zero instead, and counted.
class SPIDAR_API FiniteCheck {
 public:
  Wrench apply(const Wrench& wanted) noexcept;
  uint64_t rejected() const noexcept { return rejected_; }

 private:
  uint64_t rejected_ = 0;
};

/// Shortens force and torque to their limits, keeping their directions.
SPIDAR_API Wrench limit_total(const Wrench& wanted, const SafetyLimits& limits) noexcept;

/// Bounds the change of force and torque per second.
class SPIDAR_API SlewLimit {
 public:
  Wrench apply(const Wrench& wanted, double dt_s, const SafetyLimits& limits) noexcept;
  void reset() noexcept { last_ = {}; }

 private:
  Wrench last_;
};

/// Takes the wrench to rest when commands stop, and back in when they begin; never a step.
class SPIDAR_API StaleRamp {
 public:
  /// Share of the wrench to apply after `dt_s` more, 0 … 1. `fresh`: there is a valid command now.
  double apply(bool fresh, double dt_s, const SafetyLimits& limits) noexcept;
  void reset() noexcept { share_ = 0; }

 private:
  double share_ = 0;
};

/// Tensions within each string's range scaled by `energised` (0: motors off, 1: open). Not a number
/// counts as the minimum.
SPIDAR_API StringVector bound_tensions(const StringVector& tension_N, const Profile& profile,
                                       double energised) noexcept;

/// Tension to D/A volts by newtons_per_volt and motor_sign, clamped to the D/A range.
SPIDAR_API MotorVolts to_volts(const StringVector& tension_N, const Profile& profile) noexcept;

}  // namespace spidar
