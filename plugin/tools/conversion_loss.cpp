// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/conversion_loss.h"

#include <cmath>

#include "spidar/tools/command_line.h"

namespace spidar {
namespace {

bool is_force(size_t channel) {
  return channel < kTrackChannels / 2;
}

double full_scale(size_t channel) {
  return is_force(channel) ? kTrackForceScale_N : kTrackTorqueScale_Nm;
}

/// All channels but `axis` that contain something.
std::vector<std::string> other_channels(const TrackSummary& summary, size_t axis) {
  std::vector<std::string> others;
  for (size_t i = 0; i < kTrackChannels; ++i) {
    const double peak = summary.channels[i].peak;
    if (i == axis || peak == 0) continue;
    others.push_back(std::string(channel_name(i)) + " up to " + rounded(peak * full_scale(i)) +
                     (is_force(i) ? " N" : " N m"));
  }
  return others;
}

std::string line_of(const std::vector<std::string>& lost) {
  std::string line;
  for (const std::string& part : lost) line += (line.empty() ? "lost: " : ", ") + part;
  return line.empty() ? "" : line + '\n';
}

constexpr const char* kClipped = "what is beyond the full scale";

std::string lost_in_ahap(const TrackSummary& summary, double gain) {
  std::vector<std::string> lost = {"the direction of the force"};
  if (summary.largest_torque_Nm > 0) {
    lost.push_back("torque up to " + rounded(summary.largest_torque_Nm) + " N m");
  }
  if (gain * summary.largest_force_N > kTrackForceScale_N) lost.emplace_back(kClipped);
  return line_of(lost);
}

std::string lost_in_funscript(const TrackSummary& summary, const SaveOptions& options) {
  const size_t axis = options.axis;
  constexpr int kSteps = 50;  // on each side of the middle
  std::vector<std::string> lost = other_channels(summary, axis);
  lost.push_back("steps of " + std::string(channel_name(axis)) + " below " +
                 rounded(full_scale(axis) / kSteps / options.gain) +
                 (is_force(axis) ? " N" : " N m"));
  if (options.gain * summary.channels[axis].peak > 1) lost.emplace_back(kClipped);
  return line_of(lost);
}

std::string lost_on_a_shaker(const TrackSummary& summary, size_t axis) {
  return line_of(other_channels(summary, axis)) +
         rounded(100 * summary.channels[axis].above_30_Hz) + " % of the power of " +
         channel_name(axis) + " is above 30 Hz; a shaker plays little of what is below\n";
}

}  // namespace

std::string rounded(double value) {
  if (value == 0) return "0";
  const double step = std::pow(10, std::floor(std::log10(value)) - 1);
  return shown(std::round(value / step) * step);
}

std::string lost_in(const std::string& path, const TrackSummary& summary,
                    const SaveOptions& options) {
  if (ends_with(path, ".ahap")) return lost_in_ahap(summary, options.gain);
  if (ends_with(path, ".funscript")) return lost_in_funscript(summary, options);
  return options.rate_Hz > 0 ? lost_on_a_shaker(summary, options.axis) : "";
}

}  // namespace spidar
