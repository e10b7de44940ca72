// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Summarises a track in numbers.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "core/track/track_format.h"
#include "plugin/tracks/track_band.h"

namespace spidar::tools {

/// Statistics of one channel, in fractions of the full scale.
struct ChannelSummary {
  double peak = 0;
  double rms = 0;
  double above_30_Hz = 0;  ///< fraction of the energy; no motion in a film is this fast
};

struct TrackSummary {
  size_t samples = 0;
  std::array<ChannelSummary, kTrackChannels> channels;
  double largest_force_N = 0;
  double largest_torque_Nm = 0;
  double steepest_N_s = 0;  ///< largest rate of change of the force
  /// Fraction of the time with at least kFeltForce_N, where torque counts as the force at the
  /// radius of the grip (size_N()).
  double felt = 0;
};

/// Summarises samples, 1000 a second, that come one after the other.
class Summariser {
 public:
  void add(const TrackSample& sample);
  TrackSummary summary() const;

 private:
  TrackSummary so_far_;
  tracks::Band band_;
  Wrench before_;
  size_t felt_ = 0;
};

/// " N" or " N m".
const char* channel_unit(size_t channel);

}  // namespace spidar::tools
