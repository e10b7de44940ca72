// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <functional>
#include <iostream>
#include <mutex>
#include <thread>

#include "plugin/tools/film_recorder.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tools/track_samples.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/exit_status.h"

namespace spidar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp =
    R"(usage: spidartrack record FILM... [OPTION]... [-- PROPERTY=VALUE...]

Analyses films as fast as they can be decoded, and writes FILM's haptic track beside it, under its
name with .haptic.flac in place of the extension. Tracks that are there are left alone, so that the
command goes on where it was interrupted. Properties are those of spidarmotion: motion=camera …

  -j, --jobs N   films at a time; as many as there are processors
  --folder DIR   where tracks are written
  --format TYPE  flac (24 bits), mka or wav (both F32); flac
  --force        also those that are there
)";

struct RecordOptions {
  bool help = false;
  bool force = false;
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
  std::string folder;
  std::string format = "flac";
  std::string properties;
  std::vector<std::string> films;
};

RecordOptions parse(int argc, char** argv) {
  RecordOptions options;
  // getopt must not see the arguments after --.
  int own = 1;
  while (own < argc && std::string(argv[own]) != "--") ++own;
  for (int i = own + 1; i < argc; ++i) {
    const std::string property = argv[i];
    if (property.find('=') == std::string::npos || property.find('!') != std::string::npos) {
      throw UsageError(property + ": is no PROPERTY=VALUE");
    }
    options.properties += " " + property;
  }
  std::vector<std::string> words(argv, argv + own);
  for (size_t i = 1; i < words.size(); ++i) {
    if (words[i].rfind("-j", 0) == 0)
      words[i] = words[i] == "-j" ? "--jobs" : "--jobs=" + words[i].substr(2);
  }
  std::vector<char*> rest;
  for (std::string& word : words) rest.push_back(word.data());
  rest.push_back(nullptr);
  options.films = parse_options(
      own, rest.data(),
      {{"jobs", true,
        [&](const std::string& text) {
          options.jobs = static_cast<unsigned>(parse_number("--jobs", text, 1, 1024, ""));
        }},
       {"folder", true, [&](const std::string& text) { options.folder = text; }},
       {"format", true, [&](const std::string& text) { options.format = text; }},
       {"force", false, [&](const std::string&) { options.force = true; }},
       {"help", false, [&](const std::string&) { options.help = true; }}});
  if (options.help) return options;
  if (options.films.empty()) throw UsageError("no FILM given");
  if (encoder_of("." + options.format).empty()) {
    throw UsageError("--format: \"" + options.format + "\" is none of flac, mka, wav");
  }
  return options;
}

fs::path track_of(const std::string& film, const RecordOptions& options) {
  fs::path track(film);
  track.replace_extension(".haptic." + options.format);
  return options.folder.empty() ? track : fs::path(options.folder) / track.filename();
}

/// `track` appears when it is whole.
void record(const std::string& film, const fs::path& track, const std::string& properties,
            const std::function<void(int percent)>& tell) {
  const std::string part = (track.parent_path() / (".part-" + track.filename().string())).string();
  try {
    record_film(film, part, properties, tell);
    fs::rename(part, track);
  } catch (...) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw;
  }
}

}  // namespace

int record_track_command(int argc, char** argv) {
  const RecordOptions options = parse(argc, argv);
  if (options.help) {
    std::cout << kHelp;
    return kDone;
  }
  std::atomic<size_t> next{0}, failed{0};
  std::mutex output;
  const auto say = [&](size_t film, const std::string& text) {
    const std::lock_guard<std::mutex> lock(output);
    std::cout << '[' << film + 1 << '/' << options.films.size() << "] " << options.films[film]
              << ": " << text << std::endl;
  };
  const auto work = [&] {
    for (size_t i; (i = next++) < options.films.size();) {
      const fs::path track = track_of(options.films[i], options);
      if (!options.force && fs::exists(track)) {
        say(i, track.string() + " is there");
        continue;
      }
      try {
        record(options.films[i], track, options.properties,
               [&](int percent) { say(i, std::to_string(percent) + " %"); });
        say(i, track.string());
      } catch (const std::exception& error) {
        ++failed;
        say(i, std::string("failed: ") + error.what());
      }
    }
  };
  std::vector<std::thread> workers;
  for (unsigned i = 1; i < options.jobs && i < options.films.size(); ++i)
    workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  return failed == 0 ? kDone : kFailed;
}

}  // namespace spidar
