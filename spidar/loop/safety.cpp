// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/safety.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// Replaces negative values and NaN by zero.
double non_negative(double x) {
  return x > 0 ? x : 0;
}

/// `v` shortened to at most `max` in the same direction; zero when it has hardly any length.
Eigen::Vector3d shorten(const Eigen::Vector3d& v, double max) {
  const double norm = v.stableNorm();
  if (norm <= max) return v;
  if (!std::isfinite(norm)) return Eigen::Vector3d::Zero();
  return v * (max / norm);
}

/// Moves from `from` towards `to` by at most `step`.
Eigen::Vector3d approach(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double step) {
  const Eigen::Vector3d difference = to - from;
  const double distance = difference.stableNorm();
  if (distance <= step) return to;
  if (!std::isfinite(distance)) return from;
  return from + difference * (step / distance);
}

}  // namespace

Wrench FiniteCheck::apply(const Wrench& wanted) noexcept {
  if (wanted.is_finite()) return wanted;
  ++rejected_;
  return {};
}

Wrench limit_total(const Wrench& wanted, const SafetyLimits& limits) noexcept {
  return {shorten(wanted.force_N, non_negative(limits.max_force_N)),
          shorten(wanted.torque_Nm, non_negative(limits.max_torque_Nm))};
}

Wrench SlewLimit::apply(const Wrench& wanted, double dt_s, const SafetyLimits& limits) noexcept {
  // Both ends are within the total limits. These are balls, so every point between the ends is
  // within them, too.
  const Wrench from = limit_total(last_, limits);
  last_.force_N = approach(from.force_N, wanted.force_N, non_negative(limits.max_slew_N_s * dt_s));
  last_.torque_Nm =
      approach(from.torque_Nm, wanted.torque_Nm, non_negative(limits.max_slew_Nm_s * dt_s));
  return last_;
}

double StaleRamp::apply(bool fresh, double dt_s, const SafetyLimits& limits) noexcept {
  const double step = limits.ramp_s > 0 ? non_negative(dt_s) / limits.ramp_s : 1.0;
  way_ = fresh ? std::min(way_ + step, 1.0) : std::max(way_ - step, 0.0);
  return share();
}

Wrench WrenchSafety::apply(const Wrench& wanted, bool fresh, double dt_s,
                           const SafetyLimits& limits) noexcept {
  slew_before_ = slew_;
  stale_before_ = stale_;
  const double before = stale_.share();
  const double share = stale_.apply(fresh, dt_s, limits);
  if (fresh) return slew_.apply(share * limit_total(finite_.apply(wanted), limits), dt_s, limits);
  const double left = before > 0 ? share / before : 0;
  slew_.reset(left * limit_total(slew_.last(), limits));
  return slew_.last();
}

void WrenchSafety::undo() noexcept {
  slew_ = slew_before_;
  stale_ = stale_before_;
}

void WrenchSafety::reset() noexcept {
  slew_.reset();
  stale_.reset();
  slew_before_ = slew_;
  stale_before_ = stale_;
}

}  // namespace spidar
