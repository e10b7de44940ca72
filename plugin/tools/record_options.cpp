// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/record_options.h"

#include <algorithm>
#include <iostream>

#include "plugin/tools/processors.h"
#include "plugin/tools/track_samples.h"
#include "plugin/track/motion_sidecar.h"
#include "spidar/tools/command_line.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecordOptionsHelp =
    R"(usage: spidartrack record FILM|FOLDER... [OPTION]... [-- PROPERTY=VALUE...]

Analyses films, or all films in a folder and below, the largest first, as fast as they can be decoded, and writes the haptic track of FILM.mp4 beside it, as
FILM.mp4.haptic.flac. A track that is there is left alone, so that the command goes on where it was
interrupted; if it is that of another film, or was recorded with other properties, that is an error.
Properties are those of spidarmotion that change the force: motion=camera …

  -j, --jobs N   films at a time; as many as processors may be used
  --folder DIR   where tracks are written, those of FOLDER in the same subfolders
  --format TYPE  flac (24 bits), mka or wav (both F32); flac
  --manifest FILE  gets a line of JSON for each film: result, duration, felt share …
  --shard K/N    only piece K of N, as FILM.mp4.KofN.motion; see spidartrack join --help
  --force        also those that are there
)";

constexpr const char* kAnalyzeOptionsHelp =
    R"(usage: spidartrack analyze FILM|FOLDER... [OPTION]... [-- PROPERTY=VALUE...]

Measures all that moves in films, and writes it beside FILM.mp4, as FILM.mp4.motion: spidartrack
render makes tracks of it without the film, and spidarmotion analysis=auto plays by it. An analysis
that is there is left alone, as spidartrack record does. Properties are those that change what is
measured: quality, max-features, motion=mean, quality-level, min-distance.

  -j, --jobs N   films at a time; as many as processors may be used
  --folder DIR   where analyses are written
  --shard K/N    only piece K of N, as FILM.mp4.KofN.motion; see spidartrack join --help
  --force        also those that are there
)";

MotionPiece parse_shard(const std::string& text) {
  constexpr double kMost = 1000;
  MotionPiece piece;
  piece.program = SPIDAR_VERSION;
  const size_t slash = text.find('/');
  if (slash != std::string::npos && text.find_first_not_of("0123456789/") == std::string::npos) {
    const auto number = [](const std::string& digits, double most) {
      return static_cast<int>(parse_number("--shard", digits, 1, most, ""));
    };
    piece.of = number(text.substr(slash + 1), kMost);
    piece.number = number(text.substr(0, slash), piece.of);
    return piece;
  }
  throw UsageError("--shard: \"" + text + "\" is not of the form 2/5, the second of five pieces");
}

/// Throws UsageError for what pieces cannot be used with.
void check_shard(const RecordOptions& options) {
  if (options.piece.of == 0) return;
  if (!options.manifest.empty()) {
    throw UsageError("--manifest: it lists tracks, and a piece is none; leave it out");
  }
  for (const auto& [name, value] : options.properties.values) {
    if (name == "trace") {
      throw UsageError("trace=" + value + ": a piece is not felt; give it to spidartrack render");
    }
  }
  if (options.properties.settings.find("motion=mean") != std::string::npos) {
    throw UsageError(
        "--shard: motion=mean follows its points from the beginning to the end of the film, which "
        "has to be recorded in one piece");
  }
}

}  // namespace

fs::path RecordOptions::file_of(const ListedFilm& film) const {
  const std::string end = makes_tracks() ? ".haptic." + format : motion_end(piece);
  const fs::path file = film.path + end;
  return folder.empty() ? file : fs::path(folder) / film.subfolder / file.filename();
}

RecordOptions parse_record_options(int argc, char** argv, Purpose purpose) {
  RecordOptions options;
  options.purpose = purpose;
  const bool analyzes = purpose == Purpose::kAnalyze;
  options.jobs = usable_processors();
  // getopt must not see the arguments after --.
  int own = 1;
  while (own < argc && std::string(argv[own]) != "--") ++own;
  const std::vector<std::string> properties(argv + std::min(own + 1, argc), argv + argc);
  std::vector<std::string> words(argv, argv + own);
  for (size_t i = 1; i < words.size(); ++i) {
    if (words[i].rfind("-j", 0) == 0)
      words[i] = words[i] == "-j" ? "--jobs" : "--jobs=" + words[i].substr(2);
  }
  std::vector<char*> rest;
  for (std::string& word : words) rest.push_back(word.data());
  rest.push_back(nullptr);
  std::vector<CommandOption> known = {
      {"jobs", true,
       [&](const std::string& text) {
         options.jobs = static_cast<unsigned>(parse_number("--jobs", text, 1, 1024, ""));
       }},
      {"folder", true, [&](const std::string& text) { options.folder = text; }},
      {"force", false, [&](const std::string&) { options.force = true; }},
      {"shard", true, [&](const std::string& text) { options.piece = parse_shard(text); }},
      {"help", false, [&](const std::string&) { options.help = true; }}};
  if (!analyzes) {
    known.push_back({"format", true, [&](const std::string& text) { options.format = text; }});
    known.push_back({"manifest", true, [&](const std::string& text) { options.manifest = text; }});
  }
  const std::vector<std::string> names = parse_options(own, rest.data(), known);
  if (options.help) {
    std::cout << (analyzes ? kAnalyzeOptionsHelp : kRecordOptionsHelp);
    return options;
  }
  if (names.empty()) throw UsageError("no FILM given");
  for (const std::string& film : names) {
    if (film.find('=') == std::string::npos || fs::exists(film)) continue;
    throw UsageError(film + ": there is no such film; properties follow --: spidartrack " +
                     (analyzes ? "analyze" : "record") + " FILM -- " + film);
  }
  if (encoder_of("." + options.format).empty()) {
    throw UsageError("--format: \"" + options.format + "\" is none of flac, mka, wav");
  }
  options.films = list_films(names);
  options.properties = parse_record_properties(properties, options.films.size(), purpose);
  check_shard(options);
  if (!analyzes) options.piece.format = options.format;
  return options;
}

}  // namespace spidar
