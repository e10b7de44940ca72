// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/wrench.h"

namespace spidar {

/// The sample rate of this project's tracks: one sample a millisecond, as in the haptic loop.
constexpr int kTrackRate_Hz = 1000;
constexpr int64_t kTrackPeriod_ns = 1'000'000'000 / kTrackRate_Hz;
/// Channels of a track: fx fy fz tx ty tz, in the device frame D.
constexpr size_t kTrackChannels = 6;
/// The full scale, a sample of 1.0. Only integer encodings clip larger values.
constexpr double kTrackForceScale_N = 10;
constexpr double kTrackTorqueScale_Nm = 1;

/// All channels of the wanted wrench at one time, as fractions of the full scale.
using TrackSample = std::array<float, kTrackChannels>;

inline TrackSample to_track_sample(const Wrench& wrench) noexcept {
  TrackSample sample;
  for (size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    sample[i] = static_cast<float>(wrench.force_N[axis] / kTrackForceScale_N);
    sample[i + 3] = static_cast<float>(wrench.torque_Nm[axis] / kTrackTorqueScale_Nm);
  }
  return sample;
}

inline Wrench to_wrench(const TrackSample& sample) noexcept {
  Wrench wrench;
  for (size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    wrench.force_N[axis] = kTrackForceScale_N * static_cast<double>(sample[i]);
    wrench.torque_Nm[axis] = kTrackTorqueScale_Nm * static_cast<double>(sample[i + 3]);
  }
  return wrench;
}

/// Up to 40 successive samples at equal intervals of running time.
struct TrackBlock {
  static constexpr size_t kCapacity = 40;

  int64_t begin_ns = 0;     ///< running time of the first sample
  int64_t duration_ns = 0;  ///< of all samples; > 0
  size_t count = 0;         ///< 1 … kCapacity
  std::array<TrackSample, kCapacity> samples{};

  /// Running time of sample `i`; for `count`, that of the first sample of the next block.
  int64_t time_ns(size_t i) const noexcept {
    return begin_ns + duration_ns * static_cast<int64_t>(i) / static_cast<int64_t>(count);
  }
  int64_t period_ns() const noexcept { return duration_ns / static_cast<int64_t>(count); }
};

}  // namespace spidar
