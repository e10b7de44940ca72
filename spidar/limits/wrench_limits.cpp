// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/limits/wrench_limits.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

/// `v` shortened to at most `max` in the same direction; zero when its length is negligible.
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

Wrench limit_total(const Wrench& wanted, const SafetyLimits& limits) noexcept {
  return {shorten(wanted.force_N, non_negative(limits.max_force_N)),
          shorten(wanted.torque_Nm, non_negative(limits.max_torque_Nm))};
}

// The total limits are balls: on a straight line to a point within them, the distance to them never
// grows, and a wrench within them stays there.
Wrench limit_slew(Wrench last, const Wrench& wanted, double dt_s,
                  const SafetyLimits& limits) noexcept {
  const auto step = [dt_s](Eigen::Vector3d& from, const Eigen::Vector3d& to, double max,
                           double max_slew) {
    double left = non_negative(max_slew * dt_s);
    const double above = from.norm() - non_negative(max);
    if (above > 0) {
      from = shorten(from, from.norm() - std::min(above, left));
      left = std::max(0.0, left - above);
    }
    from = approach(from, to, left);
  };
  step(last.force_N, wanted.force_N, limits.max_force_N, limits.max_slew_N_s);
  step(last.torque_Nm, wanted.torque_Nm, limits.max_torque_Nm, limits.max_slew_Nm_s);
  return last;
}

double StaleRamp::apply(bool fresh, double dt_s, const SafetyLimits& limits) noexcept {
  const double step = limits.ramp_s > 0 ? non_negative(dt_s) / limits.ramp_s : 1.0;
  way_ = fresh ? std::min(way_ + step, 1.0) : std::max(way_ - step, 0.0);
  return fraction();
}

Wrench WrenchLimits::apply(const Wrench& wanted, bool fresh, double dt_s,
                           const SafetyLimits& limits) noexcept {
  last_before_ = last_;
  stale_before_ = stale_;
  const double before = stale_.fraction();
  const double fraction = stale_.apply(fresh, dt_s, limits);
  if (fresh) return last_ = limit_slew(last_, fraction * wanted, dt_s, limits);
  const double left = before > 0 ? fraction / before : 0;
  // A lowered limit is also reached on the way to zero.
  const Wrench within = limit_total(left * last_, limits);
  const auto step = [&](double size, double max_slew) {
    return std::max((1 - left) * size, non_negative(max_slew * dt_s));
  };
  last_ = {approach(last_.force_N, within.force_N, step(last_.force_N.norm(), limits.max_slew_N_s)),
           approach(last_.torque_Nm, within.torque_Nm,
                    step(last_.torque_Nm.norm(), limits.max_slew_Nm_s))};
  return last_;
}

void WrenchLimits::shorten_to(const Wrench& at) noexcept {
  last_ = {shorten(last_.force_N, at.force_N.norm()),
           shorten(last_.torque_Nm, at.torque_Nm.norm())};
}

void WrenchLimits::undo() noexcept {
  last_ = last_before_;
  stale_ = stale_before_;
}

void WrenchLimits::reset() noexcept {
  last_ = {};
  stale_.reset();
  last_before_ = last_;
  stale_before_ = stale_;
}

}  // namespace spidar
