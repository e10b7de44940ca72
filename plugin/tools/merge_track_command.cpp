// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "plugin/tools/film_merger.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "plugin/track/film_reader.h"
#include "plugin/track/part_file.h"
#include "plugin/track/sidecar.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/exit_status.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMergeHelp = R"(usage: spidartrack merge FILM TRACK OUT.mkv

Writes the film with its haptic track in it; neither is encoded anew. The film needs sound of its
own, or players would play the track through the loudspeakers; the track is marked as not default,
not enabled, and of no language (zxx). OUT.mkv is replaced when the new one is complete. Where the
film shows its pictures later or earlier than when the track was recorded, the track is moved by as
much. Such a track, one in HJIF, and a trace are written as F32.
)";

constexpr const char* kExtractHelp = R"(usage: spidartrack extract FILM OUT

Writes the haptic track of a film into a file of its own: OUT ends in .flac, .mka, .wav, .hjif or
.funscript.
)";

/// Two or three operands; empty when help was requested.
std::vector<std::string> parse(int argc, char** argv, const char* help_text, size_t count,
                               const char* usage) {
  bool help = false;
  std::vector<std::string> operands =
      parse_options(argc, argv, {{"help", false, [&](const std::string&) { help = true; }}});
  if (help) {
    std::cout << help_text;
    return {};
  }
  if (operands.size() != count) throw UsageError(usage);
  return operands;
}

/// For a film that shows its pictures later by so many samples, or earlier.
std::vector<TrackSample> shifted(const std::vector<TrackSample>& samples, int64_t later) {
  std::vector<TrackSample> result(static_cast<size_t>(std::max<int64_t>(0, later)));
  const auto skipped = static_cast<size_t>(std::max<int64_t>(0, -later));
  if (skipped < samples.size()) {
    result.insert(result.end(), samples.begin() + static_cast<ptrdiff_t>(skipped), samples.end());
  }
  return result;
}

}  // namespace

int merge_track_command(int argc, char** argv) {
  const std::vector<std::string> operands =
      parse(argc, argv, kMergeHelp, 3, "FILM, TRACK and OUT.mkv are needed, and nothing else");
  if (operands.empty()) return kDone;
  const std::string &film = operands[0], &track = operands[1], &out = operands[2];
  if (!ends_with(out, ".mkv")) {
    throw UsageError(out + ": a film with a track is Matroska, and ends in .mkv");
  }
  std::error_code none;
  for (const std::string& input : {film, track}) {
    if (!fs::exists(input)) throw std::runtime_error(input + ": there is no such file");
    if (fs::equivalent(input, out, none)) {
      throw UsageError(out + ": is to be another file than " + input);
    }
  }
  TrackCondition condition;
  std::vector<TrackSample> samples = load_track(track, &condition);
  PartFile part(out), sound(out + ".mka");
  bool is_sound =
      !ends_with(track, ".hjif") && !ends_with(track, ".csv") && !ends_with(track, ".jsonl");
  TrackNotes& notes = condition.notes;
  std::string lost;
  try {
    const FilmMatch match =
        match_film(read_film(film), static_cast<int64_t>(samples.size()) * kTrackPeriod_ns, notes);
    if (!match.problem.empty()) {
      throw std::runtime_error("The track is that of another film: " + match.problem + ".");
    }
    const int64_t later =
        std::llround(static_cast<double>(match.later_ns) / static_cast<double>(kTrackPeriod_ns));
    if (later != 0) {
      is_sound = false;
      samples = shifted(samples, later);
      notes.film.time_ns += later * kTrackPeriod_ns;
    }
    if (!is_sound) save_track(sound.path(), samples);
    lost = merge_film(film, is_sound ? track : sound.path(), notes, part.path());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(film + ": " + error.what());
  }
  part.publish();
  if (!lost.empty()) std::cerr << "spidartrack: " << out << ": " << lost << '\n';
  return kDone;
}

int extract_track_command(int argc, char** argv) {
  const std::vector<std::string> operands =
      parse(argc, argv, kExtractHelp, 2, "FILM and OUT are needed, and nothing else");
  if (operands.empty()) return kDone;
  TrackCondition condition;
  const std::vector<TrackSample> samples = load_track(operands[0], &condition);
  SaveOptions options;
  options.notes = condition.notes;
  save_track(operands[1], samples, options);
  return kDone;
}

}  // namespace spidar
