// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/conversion_loss.h"

#include <algorithm>
#include <cmath>

#include "plugin/tools/track_summary.h"
#include "spidar/tools/command_line.h"

namespace spidar {
namespace {

/// Two digits: this is to be read, not to be computed with.
std::string rounded(double value) {
  if (value == 0) return "0";
  const double step = std::pow(10, std::floor(std::log10(value)) - 1);
  return shown(std::round(value / step) * step);
}

/// Of all channels but `axis` that contain something.
std::string other_channels(const TrackSummary& summary, size_t axis) {
  std::string text;
  for (size_t i = 0; i < kTrackChannels; ++i) {
    const double peak = summary.channels[i].peak;
    if (i == axis || peak == 0) continue;
    const bool is_force = i < kTrackChannels / 2;
    text += std::string(channel_name(i)) + " up to " +
            rounded(peak * (is_force ? kTrackForceScale_N : kTrackTorqueScale_Nm)) +
            (is_force ? " N, " : " N m, ");
  }
  return text;
}

std::string clipped(double peak) {
  return peak > 1 ? ", what is beyond the full scale" : "";
}

}  // namespace

std::string lost_in(const std::string& path, const std::vector<TrackSample>& samples,
                    const SaveOptions& options) {
  const TrackSummary summary = summarise(samples);
  const ChannelSummary& channel = summary.channels[options.axis];
  const std::string axis = channel_name(options.axis);
  if (ends_with(path, ".ahap")) {
    const std::string torque = summary.largest_torque_Nm > 0
                                   ? ", torque up to " + rounded(summary.largest_torque_Nm) + " N m"
                                   : "";
    return "lost: the direction of the force" + torque +
           clipped(summary.largest_force_N / kTrackForceScale_N) + '\n';
  }
  if (ends_with(path, ".funscript")) {
    const bool is_force = options.axis < kTrackChannels / 2;
    const double step = (is_force ? kTrackForceScale_N : kTrackTorqueScale_Nm) / 50;
    return "lost: " + other_channels(summary, options.axis) + "steps of " + axis + " below " +
           shown(step) + (is_force ? " N" : " N m") + clipped(channel.peak) + '\n';
  }
  if (options.rate_Hz > 0) {
    return "lost: " + other_channels(summary, options.axis) +
           "on a shaker also what is slow: " + rounded(100 * channel.above_30_Hz) +
           " % of the power of " + axis + " is above 30 Hz\n";
  }
  return {};
}

}  // namespace spidar
