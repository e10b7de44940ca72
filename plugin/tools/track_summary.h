// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Summarises a track in numbers.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/track/track_format.h"

namespace spidar {

/// Statistics of one channel, in shares of the full scale.
struct ChannelSummary {
  double peak = 0;
  double rms = 0;
  double above_30_Hz = 0;  ///< share of the energy; no motion in a film is this fast
};

struct TrackSummary {
  std::array<ChannelSummary, kTrackChannels> channels;
  double largest_force_N = 0;
  double largest_torque_Nm = 0;
  double steepest_N_s = 0;  ///< largest rate of change of the force
  double felt = 0;          ///< share of the time with at least kFeltForce_N
};

TrackSummary summarise(const std::vector<TrackSample>& samples);

/// "fx", …, "tz".
const char* channel_name(size_t channel);
/// " N" or " N m".
const char* channel_unit(size_t channel);
/// What a sample of 1.0 is, in that unit.
double full_scale(size_t channel);

}  // namespace spidar
