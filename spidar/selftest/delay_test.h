// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures the lag of a device's drives while a hand holds the grip, and compares it with the lag
/// that the profile states.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "spidar/device.h"
#include "spidar/profiles/profile.h"
#include "spidar/selftest/hold.h"
#include "spidar/selftest/lag_fit.h"

namespace spidar::selftest {

struct DelaySettings {
  double peak_N = 0.4;
  int periods = 12;   ///< number of one-second periods, at least kFewestPeriods
  uint32_t seed = 1;  ///< seed of the random phases

  /// With fewer periods the estimate of the variance is too poor.
  static constexpr int kFewestPeriods = 6;
  /// The time in which the force fades in and out at the ends of a period, so that it causes no
  /// knock.
  static constexpr double kFade_s = 0.1;
  /// The time after the fade-in that is not evaluated: the swing of a loosely held grip decays.
  static constexpr double kSettle_s = 0.4;

  /// The most periods that are tried in order to obtain `periods` usable ones.
  int most_periods() const noexcept { return periods + periods / 2; }
  static constexpr double kRound_s = 2 * kFade_s + kSettle_s + Multisine::kPeriod_s;
  double seconds() const noexcept { return periods * kRound_s; }
  double most_seconds() const noexcept { return most_periods() * kRound_s; }
};

struct DelayTest {
  bool complete = true;       ///< false if the test was interrupted
  std::string error;          ///< why the test ended or has no result: a sentence, or empty
  bool is_of_device = false;  ///< `error` is a fault of the device, not only a missing result
  std::optional<LagFit> fit;
  int periods = 0;  ///< number of periods that were used

  bool measured() const noexcept { return error.empty() && fit; }
};

/// Expects a loosely held grip at rest near the centre. Pushes the grip along z, the direction in
/// which surfaces push, which uses every string. The force is a zero-mean sum of sines of 11 to 83
/// Hz on top of the minimum tensions, and passes through a HapticLoop with its whole safety chain.
/// The test ends with a ramp to zero. It ends early when the pose is lost, a string is faulty, the
/// device is lost, or the grip has moved by kFurthest_m. Throws DeviceError when the device cannot
/// be opened, and std::invalid_argument for fewer periods than kFewestPeriods. `now_ns` is
/// CLOCK_MONOTONIC, or the clock of a simulation, in ns.
DelayTest measure_delay(StringDevice& device, const Profile& profile, const Pace& pace,
                        const std::function<int64_t()>& now_ns, const DelaySettings& settings = {});

/// The largest displacement of the grip that the drift of the hand and the force may cause
/// together.
constexpr double kFurthest_m = 0.02;

struct LagVerdict {
  /// Whether the profile states a lag of at least the lower end of the confidence interval.
  bool stated_enough = false;
  /// A safe value for drive_lag_s in the profile: the upper end of the interval, rounded up to 0.1
  /// ms.
  double safe_lag_s = 0;
};

/// `answer_ns` is the time within which a board answers in 99 of 100 exchanges. While playing, the
/// loop waits for an answer no longer than boards::StringLink::kReplyWait_ns. A later answer costs
/// whole ticks, which are added to the lag.
LagVerdict judge_lag(const Profile& profile, const LagFit& fit, int64_t answer_ns);

}  // namespace spidar::selftest
