// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The largest stiffness of a surface, given the lag of the drives.
#pragma once

#include <algorithm>

#include "core/touch/contact_force.h"
#include "spidar/loop/loop_time.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// The largest stiffness for drives whose lag nobody has measured, N/m, and the lag to assume for
/// them. With both, no contact released more than 0.1 µJ, with lags from 2 to 5 ms, grips of 0.05
/// to 0.3 kg, and hands of 0.05 to 2 N s/m (bench_touch_strings).
constexpr double kUnmeasuredStiffness_N_m = 200;
constexpr double kUnmeasuredLag_s = 0.005;

/// One tick for the age of the pose, and half a tick for the zero-order hold of the force.
constexpr double kLoopDelay_s = 1.5e-9 * static_cast<double>(kTick_ns);

/// The delay from a motion of the grip to the resulting force: t_d in docs/strings.md.
constexpr double surface_delay_s(double drive_lag_s) noexcept {
  return kLoopDelay_s + drive_lag_s;
}

/// The damping that the hand must contribute for stability grows with stiffness · delay. It was
/// measured up to kMaxStiffness_N_m at the default delay of touch::ContactSettings.
inline double most_stiffness_N_m(double drive_lag_s) noexcept {
  const touch::ContactSettings measured;
  return touch::ContactSettings::kMaxStiffness_N_m *
         std::min(1.0, measured.delay_s / surface_delay_s(drive_lag_s));
}

/// The largest stiffness for a device with these drives, N/m. Measurements with a light hand were
/// stable up to kMaxStiffness_N_m at a delay of 3.5 ms (docs/strings.md). The damping that the hand
/// must contribute grows with stiffness · delay, so a longer delay lowers the limit in proportion.
/// Without a known delay, the limit is kUnmeasuredStiffness_N_m.
inline double most_stiffness_N_m(const Profile& profile) noexcept {
  const double most_N_m = most_stiffness_N_m(profile.drive_lag_s);
  return profile.drive_lag_known ? most_N_m : std::min(most_N_m, kUnmeasuredStiffness_N_m);
}

/// The known lag of these drives, or kUnmeasuredLag_s.
inline double assumed_lag_s(const Profile& profile) noexcept {
  return profile.drive_lag_known ? profile.drive_lag_s : kUnmeasuredLag_s;
}

}  // namespace spidar
