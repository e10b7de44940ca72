// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Counts of a grip that is moved or held, for calibration.
#pragma once

#include <functional>

#include "core/api.h"
#include "spidar/calibration/calibration.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar {

struct RecordingSettings {
  double seconds = 20;             ///< > 0
  double sample_period_s = 0.002;  ///< at least one tick, which is a millisecond
};

/// Called before every exchange with the time since recording began, below zero while the strings
/// are being energised: waits until that time has come. False ends the recording.
using NextTick = std::function<bool(double time_s)>;

/// Opens the device, brings the strings to their smallest tension, which keeps them taut and pushes
/// the hand nowhere on purpose, reads counts once a millisecond, and keeps one row each sample
/// period. However it ends, the strings are released by a ramp and the device is closed. Samples of
/// exchanges that failed are left out.
///
/// Throws DeviceError when the device cannot be opened or is lost, std::invalid_argument when the
/// settings are not in their range, and whatever `next_tick` throws.
SPIDAR_API CountSamples record_counts(Device& device, const Profile& profile,
                                      const RecordingSettings& settings, const NextTick& next_tick);

}  // namespace spidar
