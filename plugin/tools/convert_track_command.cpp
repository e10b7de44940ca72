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
  --tolerance SHARE  of the full scale, by which curves may differ between their points:
                     HJIF 0.0004, AHAP 0.02
)";

size_t parse_axis(const std::string& text) {
  for (size_t i = 0; i < kTrackChannels; ++i) {
    if (text == channel_name(i)) return i;
  }
  throw UsageError("--axis: \"" + text + "\" is none of fx, fy, fz, tx, ty, tz");
}

/// Throws UsageError when an option changes nothing.
void check_use(const std::string& from, const std::string& to, const SaveOptions& options,
               bool has_axis) {
  if (options.rate_Hz > 0 && encoder_of(to).empty()) {
    throw UsageError("--rate is for sound (.flac, .mka, .wav), not for " + to);
  }
  if (options.tolerance && !ends_with(to, ".hjif") && !ends_with(to, ".ahap")) {
    throw UsageError("--tolerance is for .hjif and .ahap, not for " + to);
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
  check_use(operands[0], operands[1], options, has_axis);
  TrackCondition condition;
  const std::vector<TrackSample> samples = load_track(operands[0], &condition, options.axis);
  options.notes = condition.notes;
  save_track(operands[1], samples, options);
  std::cout << lost_in(operands[1], samples, options);
  return kDone;
}

}  // namespace spidar
