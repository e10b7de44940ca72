// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "plugin/tools/sample_file.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "plugin/tools/track_summary.h"
#include "spidar/as_text.h"
#include "spidar/tools/command_line.h"

namespace spidar {
namespace {

/// Two digits: this is to be read, not to be computed with.
std::string rounded(double value) {
  if (value == 0) return "0";
  const double step = std::pow(10, std::floor(std::log10(value)) - 1);
  return as_text(std::round(value / step) * step);
}

/// All channels but `axis` that contain something.
std::vector<std::string> other_channels(const TrackSummary& summary, size_t axis) {
  std::vector<std::string> others;
  for (size_t i = 0; i < kTrackChannels; ++i) {
    const double peak = summary.channels[i].peak;
    if (i == axis || peak == 0) continue;
    others.push_back(std::string(channel_name(i)) + " up to " + rounded(peak * full_scale(i)) +
                     channel_unit(i));
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
                 rounded(full_scale(axis) / kSteps / options.gain) + channel_unit(axis));
  if (options.gain * summary.channels[axis].peak > 1) lost.emplace_back(kClipped);
  return line_of(lost);
}

/// What save_track() with the same options has lost of a track, in whole lines: "lost: fx up to 1.2
/// N, steps of fy below 0.2 N". Empty for formats that hold all six channels.
std::string lost_in(const std::string& path, const TrackSummary& summary,
                    const SaveOptions& options) {
  if (ends_with(path, ".ahap")) return lost_in_ahap(summary, options.gain);
  if (ends_with(path, ".funscript")) return lost_in_funscript(summary, options);
  return "";
}

/// The channel in which most happens, as a fraction of its full scale.
size_t liveliest_channel(const TrackSummary& summary) {
  size_t most = kUsualAxis;
  for (size_t i = 0; i < kTrackChannels; ++i) {
    if (summary.channels[i].rms > summary.channels[most].rms) most = i;
  }
  return most;
}

size_t channel_of(const std::string& axis) {
  for (size_t i = 0; i < kTrackChannels; ++i) {
    if (axis == channel_name(i)) return i;
  }
  return kUsualAxis;
}

/// What is to be known of the channel of a funscript, as a line; empty: nothing.
std::string about_axis(const TrackSummary& summary, size_t axis, bool is_chosen) {
  const size_t liveliest = liveliest_channel(summary);
  const std::string name = channel_name(axis);
  if (summary.channels[liveliest].peak == 0) return "the whole track is at rest\n";
  if (summary.channels[axis].peak == 0) {
    return "axis " + name + " is at rest; --axis " + channel_name(liveliest) +
           " has the most motion\n";
  }
  return is_chosen ? "" : "axis " + name + ", which has the most motion; --axis chooses another\n";
}

/// What TO is for is not a grip, and has a range of its own instead of newtons.
bool has_own_range(const std::string& to) {
  return ends_with(to, ".ahap") || ends_with(to, ".funscript");
}

/// The gain with which the largest value fills the range of TO; 1 when there is none.
double filling_gain(const std::string& to, const TrackSummary& summary, size_t axis) {
  const double peak = ends_with(to, ".ahap") ? summary.largest_force_N / kTrackForceScale_N
                                             : summary.channels[axis].peak;
  return peak > 0 ? 1 / peak : 1;
}

/// Throws UsageError when an option changes nothing.
void check_use(const ConvertOptions& options) {
  const std::string& to = options.to;
  if (options.save.tolerance && !has_own_range(to) && !ends_with(to, ".hjif")) {
    throw UsageError("--tolerance is for .hjif, .ahap and .funscript, not for " + to);
  }
  if (options.gain && !has_own_range(to)) {
    throw UsageError("--gain is for .funscript and .ahap, not for " + to +
                     ", whose samples are newtons");
  }
  if (!options.axis.empty() && !ends_with(to, ".funscript") &&
      !ends_with(options.from, ".funscript")) {
    throw UsageError("--axis is for .funscript, not for " + to);
  }
}

}  // namespace

int convert_track(const ConvertOptions& options) {
  const std::string& to = options.to;
  std::error_code none;
  if (std::filesystem::equivalent(options.from, to, none)) {
    throw UsageError(to + ": is to be another file than " + options.from);
  }
  check_use(options);
  SaveOptions save = options.save;
  save.axis = channel_of(options.axis);
  check_format(to);
  PartFile part(to, {options.force, "spidartrack convert"});
  SampleFile samples(to);
  Summariser summariser;
  const TrackCondition condition = read_track(
      options.from,
      [&](const TrackSample& sample) {
        samples.add(sample);
        summariser.add(sample);
      },
      save.axis);
  samples.flush();
  expect_own_track(condition);
  save.notes = condition.notes;
  const TrackSummary summary = summariser.summary();
  if (ends_with(to, ".funscript")) {
    if (options.axis.empty()) save.axis = liveliest_channel(summary);
    std::cout << about_axis(summary, save.axis, !options.axis.empty());
  }
  if (has_own_range(to)) {
    save.gain = options.gain.value_or(filling_gain(to, summary, save.axis));
    std::cout << "gain " << rounded(save.gain)
              << (options.gain ? ""
                               : ": the largest value fills the range; --gain 1 keeps it as it is")
              << '\n';
  }
  save_track(part, samples, save);
  publish(part);
  std::cout << lost_in(to, summary, save);
  return kDone;
}

}  // namespace spidar
