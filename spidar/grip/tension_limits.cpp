// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/grip/tension_limits.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// Replaces negative values and NaN by zero.
double non_negative(double x) {
  return x > 0 ? x : 0;
}

}  // namespace

StringVector TensionSlew::apply(const StringVector& tension_N, const Profile& profile,
                                double dt_s) noexcept {
  StringVector wanted_N = tension_N;
  double share = 1;
  for (int i = 0; i < profile.geometry.count; ++i) {
    const StringDrive& drive = profile.drives[static_cast<size_t>(i)];
    if (!std::isfinite(wanted_N[i])) wanted_N[i] = drive.min_tension_N;
    const double allowed_N =
        non_negative(dt_s) / kRange_s * (drive.max_tension_N - drive.min_tension_N);
    const double change_N = std::fabs(wanted_N[i] - last_N_[i]);
    if (change_N > allowed_N) share = std::min(share, allowed_N / change_N);
  }
  last_N_ = share < 1 ? StringVector(last_N_ + share * (wanted_N - last_N_)) : wanted_N;
  return last_N_;
}

StringVector bound_tensions(const StringVector& tension_N, const Profile& profile) noexcept {
  StringVector bounded = StringVector::Zero();
  for (int i = 0; i < profile.geometry.count; ++i)
    bounded[i] =
        std::min(non_negative(tension_N[i]), profile.drives[static_cast<size_t>(i)].max_tension_N);
  return bounded;
}

MotorVolts to_volts(const StringVector& tension_N, const Profile& profile) noexcept {
  MotorVolts volts;
  for (int i = 0; i < profile.geometry.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile.drives[k];
    const double magnitude = non_negative(tension_N[i] / drive.newtons_per_volt);
    volts.volt[k] = drive.motor_sign * std::min(magnitude, profile.dac_max_V);
  }
  return volts;
}

}  // namespace spidar
