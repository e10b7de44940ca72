// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/record_options.h"

#include <algorithm>
#include <iostream>

#include "plugin/tools/processors.h"
#include "plugin/tools/track_samples.h"
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
  --force        also those that are there
)";

}  // namespace

fs::path RecordOptions::file_of(const ListedFilm& film) const {
  const fs::path file = film.path + ".haptic." + format;
  return folder.empty() ? file : fs::path(folder) / film.subfolder / file.filename();
}

RecordOptions parse_record_options(int argc, char** argv) {
  RecordOptions options;
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
  const std::vector<CommandOption> known = {
      {"jobs", true,
       [&](const std::string& text) {
         options.jobs = static_cast<unsigned>(parse_number("--jobs", text, 1, 1024, ""));
       }},
      {"folder", true, [&](const std::string& text) { options.folder = text; }},
      {"force", false, [&](const std::string&) { options.force = true; }},
      {"format", true, [&](const std::string& text) { options.format = text; }},
      {"manifest", true, [&](const std::string& text) { options.manifest = text; }},
      {"help", false, [&](const std::string&) { options.help = true; }}};
  const std::vector<std::string> names = parse_options(own, rest.data(), known);
  if (options.help) {
    std::cout << kRecordOptionsHelp;
    return options;
  }
  if (names.empty()) throw UsageError("no FILM given");
  for (const std::string& film : names) {
    if (film.find('=') == std::string::npos || fs::exists(film)) continue;
    throw UsageError(
        film + ": there is no such film; properties follow --: spidartrack record FILM -- " + film);
  }
  if (encoder_of("." + options.format).empty()) {
    throw UsageError("--format: \"" + options.format + "\" is none of flac, mka, wav");
  }
  options.films = list_films(names);
  options.properties = parse_record_properties(properties, options.films.size());
  return options;
}

}  // namespace spidar
