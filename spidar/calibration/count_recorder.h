// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Records the counts of a grip that is moved or held, for calibration.
#pragma once

#include <functional>

#include "spidar/calibration/calibration.h"
#include "spidar/device.h"
#include "spidar/profiles/profile.h"

namespace spidar {

struct RecordingSettings {
  double seconds = 20;             ///< > 0
  double sample_period_s = 0.002;  ///< at least one tick, which is a millisecond
};

/// Called before every exchange with the time since recording began, which is negative while the
/// strings are being energised. Waits until that time. Returning false ends the recording.
using NextTick = std::function<bool(double time_s)>;

/// Opens the device and sets the strings to their minimum tension, which keeps them taut without a
/// deliberate force on the hand. Then reads counts once a millisecond and stores one row in each
/// sample period. In every case, a ramp releases the strings at the end, and the device is closed.
/// Failed exchanges give no sample.
///
/// Throws DeviceError when the device cannot be opened or is lost, std::invalid_argument when the
/// settings are out of range, and whatever `next_tick` throws.
CountSamples record_counts(Device& device, const Profile& profile,
                           const RecordingSettings& settings, const NextTick& next_tick);

}  // namespace spidar
