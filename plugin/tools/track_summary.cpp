// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/track_summary.h"

#include <algorithm>
#include <cmath>

#include "core/force/motion_rendering.h"

namespace spidar::tools {

const char* channel_unit(size_t channel) {
  return channel < kTrackChannels / 2 ? " N" : " N m";
}

void Summariser::add(const TrackSample& sample) {
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    const double value = sample[channel];
    double& peak = so_far_.channels[channel].peak;
    peak = std::max(peak, std::fabs(value));
  }
  band_.add(sample);
  const Wrench wrench = to_wrench(sample);
  so_far_.largest_force_N = std::max(so_far_.largest_force_N, wrench.force_N.norm());
  so_far_.largest_torque_Nm = std::max(so_far_.largest_torque_Nm, wrench.torque_Nm.norm());
  if (so_far_.samples > 0) {
    const double change_N_s = (wrench.force_N - before_.force_N).norm() * kTrackRate_Hz;
    so_far_.steepest_N_s = std::max(so_far_.steepest_N_s, change_N_s);
  }
  felt_ += size_N(wrench) >= kFeltForce_N ? 1 : 0;
  before_ = wrench;
  ++so_far_.samples;
}

TrackSummary Summariser::summary() const {
  TrackSummary summary = so_far_;
  if (summary.samples == 0) return summary;
  const auto samples = static_cast<double>(summary.samples);
  summary.felt = static_cast<double>(felt_) / samples;
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    summary.channels[channel].rms = std::sqrt(band_.energy(channel) / samples);
    summary.channels[channel].above_30_Hz = band_.above_30_Hz(channel);
  }
  return summary;
}

}  // namespace spidar::tools
