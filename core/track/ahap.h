// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Haptic tracks in AHAP, the files of Core Haptics.
#pragma once

#include <string>
#include <vector>

#include "core/track/track_format.h"

namespace spidar {

/// A vibration as strong as the force: a continuous event whose intensity is the magnitude of the
/// force as a share of the full scale, along straight lines that differ from it by at most
/// `tolerance`, and half of 1e-3. A telephone has neither directions nor torque, so both are lost.
/// Magnitudes beyond the full scale are clipped, and NaN becomes 0.
///
/// Source: Apple, "Representing haptic patterns in AHAP files", and CHHapticEvent.duration: an
/// event lasts 30 s at most. Users report that only the first 16 points of a curve are used.
std::string write_ahap(const std::vector<TrackSample>& samples, double tolerance = 0.02);

}  // namespace spidar
