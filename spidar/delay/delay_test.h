// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures how late the drives of a device answer, with a hand on its grip.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/api.h"
#include "core/delay/lag_fit.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"
#include "spidar/wiring/string_hold.h"

namespace spidar {

struct DelayTestSettings {
  double peak_N = 0.4;  ///< largest force
  int periods = 12;     ///< of a second each, at least kFewestPeriods
  uint32_t seed = 1;    ///< of the phases

  /// Fewer tell too little about how much they differ.
  static constexpr int kFewestPeriods = 6;
  /// Force rises and falls in this time at both ends of a period, so that nothing knocks.
  static constexpr double kFade_s = 0.1;
  /// Between the rise and what is measured, for the swing of a loosely held grip to fade.
  static constexpr double kSettle_s = 0.4;

  /// So many may be tried for that many which are whole.
  int most_periods() const noexcept { return periods + periods / 2; }
  static constexpr double kRound_s = 2 * kFade_s + kSettle_s + Multisine::kPeriod_s;
  double seconds() const noexcept { return periods * kRound_s; }
  double most_seconds() const noexcept { return most_periods() * kRound_s; }
};

struct DelayTest {
  bool complete = true;  ///< it was not interrupted
  std::string trouble;   ///< why it was ended or has no number; a sentence, or empty
  bool fault = false;    ///< of the device: that trouble is more than a number that is missing
  std::optional<LagFit> fit;
  int periods = 0;       ///< that were used
  double moved_m = 0;    ///< furthest from where the grip was at the beginning
  double largest_N = 0;  ///< force that was commanded

  /// There is a number.
  bool measured() const noexcept { return trouble.empty() && fit && fit->missing == NoLag::kNone; }
};

/// CLOCK_MONOTONIC, or that of a simulation.
using MonotonicClock = std::function<int64_t()>;

/// The grip has to be at rest near the centre, held loosely. Pushes it along z, towards and away
/// from the viewer, as surfaces do and with every string: a sum of sines of 11 to 83 Hz about zero,
/// through a HapticLoop and so through the whole safety chain, above the least tensions. Ends with
/// a ramp to zero, at once when the pose is lost, a string is faulty, the device is lost, or the
/// grip is kFurthest_m away. Throws DeviceError when the device cannot be opened.
SPIDAR_API DelayTest measure_delay(Device& device, const Profile& profile, const Pace& pace,
                                   const MonotonicClock& now_ns,
                                   const DelayTestSettings& settings = {});

/// So far may the grip go, by the sum of its hand's drift and the force.
constexpr double kFurthest_m = 0.02;

}  // namespace spidar
