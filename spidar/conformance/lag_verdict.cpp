// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/conformance/lag_verdict.h"

#include <algorithm>
#include <cmath>

#include "core/touch/contact_force.h"
#include "spidar/loop/haptic_loop.h"
#include "spidar/loop/stiffness_limit.h"

namespace spidar {

LagVerdict judge_lag(const Profile& profile, const LagFit& fit, int late_ticks) {
  LagVerdict verdict;
  verdict.late_ticks = late_ticks;
  const double late_s = 1e-9 * static_cast<double>(late_ticks * kTick_ns);
  const double most_s = std::max(0.0, fit.most_s) + late_s;
  if (profile.drive_lag_s < fit.least_s + late_s) verdict.stated = StatedLag::kTooSmall;
  if (profile.drive_lag_s > most_s) verdict.stated = StatedLag::kMore;
  // The tolerance keeps rounding errors from adding a step.
  constexpr double kStep_s = 1e-4;
  verdict.safe_lag_s = kStep_s * std::ceil(most_s / kStep_s - 1e-6);
  verdict.delay_s = surface_delay_s(verdict.safe_lag_s);
  verdict.stiffness_N_m = most_stiffness_N_m(verdict.safe_lag_s);
  ContactSettings surface;
  surface.stiffness_N_m = verdict.stiffness_N_m;
  surface.delay_s = verdict.delay_s;
  verdict.damping_N_s_m = surface.damping_N_s_m();
  return verdict;
}

}  // namespace spidar
