// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <filesystem>
#include <iostream>

#include "plugin/tools/conversion_loss.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "plugin/tools/track_summary.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/exit_status.h"

namespace spidar {
namespace {

constexpr const char* kConvertTrackHelp = R"(usage: spidartrack convert FROM TO [OPTION]...

FROM is a track in FLAC, Matroska, WAV or another container, in HJIF (.hjif), a trace of
spidarmotion (.csv, .jsonl), or a funscript. TO is what its name ends in: .flac, .mka, .wav, .hjif,
.ahap (a vibration for telephones) or .funscript; a file of this name is replaced when the new one is
complete. What TO cannot hold is printed.

  --axis CHANNEL     of a funscript, and with --rate: fx, fy, fz, tx, ty or tz; fy
  --rate HZ          sound with this channel alone, as for a bass shaker: 48000
  --gain FACTOR      of what has a range of its own: funscript, AHAP and sound with --rate;
                     so much that the largest value of the track fills the range
  --tolerance SHARE  of the full scale, by which curves may differ between their points:
                     HJIF 0.0004, AHAP 0.02, funscript 0.01
)";

size_t parse_axis(const std::string& text) {
  for (size_t i = 0; i < kTrackChannels; ++i) {
    if (text == channel_name(i)) return i;
  }
  throw UsageError("--axis: \"" + text + "\" is none of fx, fy, fz, tx, ty, tz");
}

/// What TO is for is not a grip, and has a range of its own instead of newtons.
bool has_own_range(const std::string& to, const SaveOptions& options) {
  return options.rate_Hz > 0 || ends_with(to, ".ahap") || ends_with(to, ".funscript");
}

/// The gain with which the largest value fills the range of TO; 1 when there is none.
double filling_gain(const std::string& to, const TrackSummary& summary,
                    const SaveOptions& options) {
  // Of sound, a resampled peak may lie between two samples, and be higher than both.
  constexpr double kSoundPeak = 0.9;
  const double peak = ends_with(to, ".ahap") ? summary.largest_force_N / kTrackForceScale_N
                                             : summary.channels[options.axis].peak;
  const double range = options.rate_Hz > 0 ? kSoundPeak : 1;
  return peak > 0 ? range / peak : 1;
}

std::vector<TrackSample> amplified(std::vector<TrackSample> samples, double gain) {
  for (TrackSample& sample : samples) {
    for (float& value : sample) value = static_cast<float>(gain * value);
  }
  return samples;
}

/// Throws UsageError when an option changes nothing.
void check_use(const std::string& from, const std::string& to, const SaveOptions& options,
               bool has_axis, bool has_gain) {
  if (options.rate_Hz > 0 && encoder_of(to).empty()) {
    throw UsageError("--rate is for sound (.flac, .mka, .wav), not for " + to);
  }
  const bool has_lines =
      ends_with(to, ".hjif") || ends_with(to, ".ahap") || ends_with(to, ".funscript");
  if (options.tolerance && !has_lines) {
    throw UsageError("--tolerance is for .hjif, .ahap and .funscript, not for " + to);
  }
  if (has_gain && !has_own_range(to, options)) {
    throw UsageError("--gain is for .funscript, .ahap and sound with --rate, not for " + to +
                     ", whose samples are newtons");
  }
  if (has_axis && options.rate_Hz == 0 && !ends_with(to, ".funscript") &&
      !ends_with(from, ".funscript")) {
    throw UsageError("--axis is for .funscript, and for sound with --rate, not for " + to);
  }
}

}  // namespace

int convert_track_command(int argc, char** argv) {
  bool help = false, has_axis = false;
  SaveOptions options;
  std::optional<double> gain;
  const std::vector<std::string> operands = parse_options(
      argc, argv,
      {{"tolerance", true,
        [&](const std::string& text) {
          options.tolerance = parse_number("--tolerance", text, 0, 1, "");
        }},
       {"axis", true,
        [&](const std::string& text) {
          options.axis = parse_axis(text);
          has_axis = true;
        }},
       {"gain", true,
        [&](const std::string& text) { gain = parse_number("--gain", text, 1e-3, 1e6, ""); }},
       {"rate", true,
        [&](const std::string& text) {
          options.rate_Hz = static_cast<int>(parse_number("--rate", text, 1000, 192000, "Hz"));
        }},
       {"help", false, [&](const std::string&) { help = true; }}});
  if (help) {
    std::cout << kConvertTrackHelp;
    return kDone;
  }
  if (operands.size() != 2) throw UsageError("FROM and TO are needed, and nothing else");
  std::error_code none;
  if (std::filesystem::equivalent(operands[0], operands[1], none)) {
    throw UsageError(operands[1] + ": is to be another file than " + operands[0]);
  }
  check_use(operands[0], operands[1], options, has_axis, gain.has_value());
  TrackCondition condition;
  const std::vector<TrackSample> samples = load_track(operands[0], &condition, options.axis);
  options.notes = condition.notes;
  const TrackSummary summary = summarise(samples);
  if (has_own_range(operands[1], options)) {
    options.gain = gain.value_or(filling_gain(operands[1], summary, options));
    std::cout << "gain " << rounded(options.gain)
              << (gain ? "" : ": the largest value fills the range; --gain 1 keeps it as it is")
              << '\n';
  }
  save_track(operands[1], amplified(samples, options.gain), options);
  std::cout << lost_in(operands[1], summary, options);
  return kDone;
}

}  // namespace spidar
