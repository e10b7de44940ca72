// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What there is to say of a track in numbers.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/track/track_format.h"

namespace spidar {

/// Of one channel, in shares of the full scale.
struct ChannelSummary {
  double peak = 0;
  double rms = 0;
  double above_30_Hz = 0;  ///< share of the energy; nothing that moves in a film is so fast
};

struct TrackSummary {
  std::array<ChannelSummary, kTrackChannels> channels;
  double largest_force_N = 0;
  double largest_torque_Nm = 0;
  double steepest_N_s = 0;  ///< change of the force
};

TrackSummary summarise(const std::vector<TrackSample>& samples);

/// "fx", …, "tz".
const char* channel_name(size_t channel);

}  // namespace spidar
