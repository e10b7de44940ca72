// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Estimates how warm the motors are from the tensions that they have produced.
#pragma once

#include <algorithm>

#include "core/grip/string_geometry.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// I²t: the tension of a motor is proportional to its current, and the heat to the square of the
/// current. Each motor is modelled as a body with one time constant. Heat 1 is the final value when
/// the motor produces its continuous tension indefinitely. Nothing is measured; the motors are
/// assumed to be cold when this object is created.
class MotorHeat {
 public:
  /// From this heat on, a motor is limited to less than its largest tension, and at heat 1 to its
  /// continuous tension. No sequence of tensions within limit_N() raises the heat above 1.
  static constexpr double kLimitFrom = 0.8;

  explicit MotorHeat(const Profile& profile) : profile_(profile) {
    // A profile that was not read from a file may lack it.
    for (StringDrive& drive : profile_.drives)
      if (!(drive.continuous_tension_N > 0)) drive.continuous_tension_N = drive.max_tension_N / 2;
  }

  /// The motors have produced `tension_N` for `dt_s`.
  void pass(const StringVector& tension_N, double dt_s) noexcept {
    for (int i = 0; i < profile_.geometry.count; ++i) {
      const StringDrive& drive = profile_.drives[static_cast<size_t>(i)];
      const double load = tension_N[i] / drive.continuous_tension_N;
      heat_[i] += (load * load - heat_[i]) * std::clamp(dt_s / drive.heating_time_s, 0.0, 1.0);
    }
  }

  /// Largest permitted tension of each string at its present heat, N.
  StringVector limit_N() const noexcept {
    StringVector limit_N = StringVector::Zero();
    for (int i = 0; i < profile_.geometry.count; ++i) {
      const StringDrive& drive = profile_.drives[static_cast<size_t>(i)];
      const double room = std::clamp((1 - heat_[i]) / (1 - kLimitFrom), 0.0, 1.0);
      const double continuous_N = drive.continuous_tension_N;
      limit_N[i] = continuous_N + room * (drive.max_tension_N - continuous_N);
    }
    return limit_N;
  }

  /// Heat of the warmest motor.
  double hottest() const noexcept { return heat_.head(profile_.geometry.count).maxCoeff(); }

 private:
  Profile profile_;
  StringVector heat_ = StringVector::Zero();
};

}  // namespace spidar
