// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "core/track/track_format.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "plugin/tracks/track_summary.h"
#include "spidar/text.h"
#include "spidar/tools/command_line.h"
#include "spidar/whole_file.h"

namespace spidar::tools {

namespace {

/// The paths of six funscripts for the six channels of a track, as players of several axes read
/// them. The channel `main` has "film.funscript"; the others have the names that MultiFunPlayer and
/// other players search, such as "film.surge.funscript" (surge forwards, sway sideways, twist about
/// the vertical, roll, pitch). The vertical force, which usually is `main`, has the name of the
/// channel that replaces it.
std::array<std::string, kTrackChannels> axis_scripts(const std::string& path, size_t main) {
  // By channel: fx, fy, fz, tx, ty, tz. The first axis of a player is the vertical one.
  constexpr const char* kNames[kTrackChannels] = {".sway",  "",       ".surge",
                                                  ".pitch", ".twist", ".roll"};
  const std::filesystem::path whole = path;
  std::array<std::string, kTrackChannels> scripts;
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    const size_t place = channel == main ? kUsualAxis : channel == kUsualAxis ? main : channel;
    const std::string name = whole.stem().string() + kNames[place] + whole.extension().string();
    scripts[channel] = (whole.parent_path() / name).string();
  }
  return scripts;
}

std::vector<std::string> other_channels(const tracks::Summary& summary, size_t axis) {
  std::vector<std::string> others;
  for (size_t i = 0; i < kTrackChannels; ++i) {
    const double peak = summary.channels[i].peak;
    if (i == axis || peak == 0) continue;
    others.push_back(std::string(tracks::channel_name(i)) + " up to " +
                     tracks::rounded(peak * tracks::full_scale(i)) + tracks::channel_unit(i));
  }
  return others;
}

std::string line_of(const std::vector<std::string>& lost) {
  std::string line;
  for (const std::string& part : lost) line += (line.empty() ? "lost: " : ", ") + part;
  return line.empty() ? "" : line + '\n';
}

constexpr const char* kClipped = "what is beyond the full scale";

std::string lost_in_ahap(const tracks::Summary& summary, double gain) {
  std::vector<std::string> lost = {"the direction of the force"};
  if (summary.largest_torque_Nm > 0) {
    lost.push_back("torque up to " + tracks::rounded(summary.largest_torque_Nm) + " N m");
  }
  if (gain * summary.largest_force_N > kTrackForceScale_N) lost.emplace_back(kClipped);
  return line_of(lost);
}

std::string lost_in_funscript(const tracks::Summary& summary, const SaveOptions& options) {
  const size_t axis = options.axis;
  constexpr int kSteps = 50;  // on each side of the middle
  std::vector<std::string> lost = other_channels(summary, axis);
  lost.push_back("steps of " + std::string(tracks::channel_name(axis)) + " below " +
                 tracks::rounded(tracks::full_scale(axis) / kSteps / options.gain) +
                 tracks::channel_unit(axis));
  if (options.gain * summary.channels[axis].peak > 1) lost.emplace_back(kClipped);
  return line_of(lost);
}

/// Returns what save_track() with the same options loses of a track, as whole lines: "lost: fx up
/// to 1.2 N, steps of fy below 0.2 N". Empty for formats that hold all six channels.
std::string lost_in(const std::string& path, const tracks::Summary& summary,
                    const SaveOptions& options) {
  if (ends_with(path, ".ahap")) return lost_in_ahap(summary, options.gain);
  if (ends_with(path, ".funscript")) return lost_in_funscript(summary, options);
  return "";
}

/// The channel with the largest rms value, as a fraction of its full scale.
size_t strongest_channel(const tracks::Summary& summary) {
  size_t most = kUsualAxis;
  for (size_t i = 0; i < kTrackChannels; ++i) {
    if (summary.channels[i].rms > summary.channels[most].rms) most = i;
  }
  return most;
}

size_t channel_of(const std::string& axis) {
  for (size_t i = 0; i < kTrackChannels; ++i) {
    if (axis == tracks::channel_name(i)) return i;
  }
  return kUsualAxis;
}

/// A remark on the channel of a funscript, as a line; empty: none.
std::string about_axis(const tracks::Summary& summary, size_t axis, bool is_chosen) {
  const size_t strongest = strongest_channel(summary);
  const std::string name = tracks::channel_name(axis);
  if (summary.channels[strongest].peak == 0) return "the whole track is at rest\n";
  if (summary.channels[axis].peak == 0) {
    return "axis " + name + " is at rest; --axis " + tracks::channel_name(strongest) +
           " has the most motion\n";
  }
  return is_chosen ? "" : "axis " + name + ", which has the most motion; --axis chooses another\n";
}

/// Whether TO has a range of its own instead of newtons, for devices other than a grip.
bool has_own_range(const std::string& to) {
  return ends_with(to, ".ahap") || ends_with(to, ".funscript");
}

/// The gain that makes `peak`, a fraction of the full scale, 1; 1 when the peak is zero.
double gain_that_fills(double peak) {
  return peak > 0 ? std::clamp(1 / peak, kMinGain, kMaxGain) : 1;
}

/// The gain with which the largest value fills the range of TO; 1 when there is none.
double filling_gain(const std::string& to, const tracks::Summary& summary, size_t axis) {
  const double peak = ends_with(to, ".ahap") ? summary.largest_force_N / kTrackForceScale_N
                                             : summary.channels[axis].peak;
  return gain_that_fills(peak);
}

/// Throws UsageError when an option changes nothing.
void check_use(const ConvertOptions& options) {
  const std::string& to = options.to;
  if (options.save.tolerance && !has_own_range(to) && !ends_with(to, ".hjif")) {
    throw UsageError("--tolerance is for .hjif, .ahap and .funscript, not for " + to);
  }
  const bool is_script = tracks::is_script(options.from);
  if (options.gain && !has_own_range(to) && !is_script) {
    throw UsageError("--gain is for .funscript and .ahap, not for " + to +
                     ", whose samples are newtons");
  }
  if (!options.axis.empty() && !ends_with(to, ".funscript") && !is_script) {
    throw UsageError("--axis is for .funscript, not for " + to);
  }
}

/// Writes six funscripts of a track. The forces have one gain and the torques another, which keeps
/// their directions.
void write_axes(const ConvertOptions& options, const SampleFile& samples,
                const tracks::Summary& summary) {
  const size_t main = strongest_channel(summary);
  constexpr size_t kForces = kTrackChannels / 2;
  std::array<double, 2> gains{1, 1};
  for (const size_t kind : {size_t{0}, size_t{1}}) {
    double peak = 0;
    for (size_t i = kind * kForces; i < (kind + 1) * kForces; ++i) {
      peak = std::max(peak, summary.channels[i].peak);
    }
    gains[kind] = options.gain.value_or(gain_that_fills(peak));
  }
  std::vector<std::unique_ptr<PartFile>> parts;
  const auto scripts = axis_scripts(options.to, main);
  for (size_t channel = 0; channel < kTrackChannels; ++channel) {
    parts.push_back(std::make_unique<PartFile>(
        scripts[channel],
        PartFile::Replaces{options.force, "spidartrack convert", scripts[channel] == options.to}));
    SaveOptions save = options.save;
    save.axis = channel;
    save.gain = gains[channel / kForces];
    save_track(*parts.back(), samples, save);
  }
  for (size_t i = 0; i < parts.size(); ++i) {
    publish(*parts[i]);
    std::cout << scripts[i] << ": " << tracks::channel_name(i) << ", gain "
              << tracks::rounded(gains[i / kForces]) << '\n';
  }
}

}  // namespace

int convert_track(const ConvertOptions& options) {
  const std::string& to = options.to;
  note_read(options.from);
  check_use(options);
  SaveOptions save = options.save;
  save.axis = channel_of(options.axis);
  check_format(to);
  const bool is_all = options.axis == kAllAxes;
  std::unique_ptr<PartFile> part;
  if (!is_all || !ends_with(to, ".funscript")) {
    part = std::make_unique<PartFile>(to, PartFile::Replaces{options.force, "spidartrack convert"});
  }
  SampleFile samples(to);
  tracks::Summariser summariser;
  const SampleSource::Take take = [&](const TrackSample& sample) {
    samples.add(sample);
    summariser.add(sample);
  };
  tracks::ScriptChoice script;
  if (!options.axis.empty() && !is_all) script.channel = save.axis;
  if (!has_own_range(to)) script.gain = options.gain;
  const TrackCondition condition = read_track(options.from, take, script);
  samples.flush();
  for (const std::string& line : condition.about) std::cout << line << '\n';
  expect_own_track(condition);
  save.notes = condition.notes;
  const tracks::Summary summary = summariser.summary();
  if (!part) {
    write_axes(options, samples, summary);
    return kDone;
  }
  if (ends_with(to, ".funscript")) {
    if (options.axis.empty()) save.axis = strongest_channel(summary);
    std::cout << about_axis(summary, save.axis, !options.axis.empty());
  }
  if (has_own_range(to)) {
    save.gain = options.gain.value_or(filling_gain(to, summary, save.axis));
    std::cout << "gain " << tracks::rounded(save.gain)
              << (options.gain ? ""
                               : ": the largest value fills the range; --gain 1 keeps it as it is")
              << '\n';
  }
  save_track(*part, samples, save);
  publish(*part);
  std::cout << lost_in(to, summary, save);
  return kDone;
}

}  // namespace spidar::tools
