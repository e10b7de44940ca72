// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Haptic tracks: records, looks at, checks, converts, draws and merges them.

#include <exception>
#include <iostream>
#include <string>

#include <gst/gst.h>

#include "plugin/tools/spidartrack_commands.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/commands.h"

namespace {

using namespace spidar;

struct Command {
  const char* name;
  int (*run)(int argc, char** argv);
};

constexpr Command kCommands[] = {
    {"record", record_track_command},   {"info", track_info_command},
    {"check", check_track_command},     {"convert", convert_track_command},
    {"plot", plot_track_command},       {"merge", merge_track_command},
    {"extract", extract_track_command},
};

constexpr const char* kHelp = R"(usage: spidartrack COMMAND

  record   what is to be felt of films, into files beside them
  info     length and size of a track
  check    whether a track can be felt as it is
  convert  FLAC, Matroska, WAV, HJIF, a trace of spidarmotion, funscript
  plot     a picture of a track
  merge    a film with its track in it
  extract  the track of such a film
  --help
  --version

spidartrack COMMAND --help says more.
)";

int run(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  std::string known;
  for (const Command& command : kCommands) {
    if (name == command.name) return command.run(argc - 1, argv + 1);
    known += (known.empty() ? "" : ", ") + std::string(command.name);
  }
  if (name == "--version") {
    std::cout << "spidartrack " SPIDAR_VERSION "\n";
    return kDone;
  }
  if (name == "--help") {
    std::cout << kHelp;
    return kDone;
  }
  throw UsageError((name.empty() ? "no command" : name + " is not a command") + "; commands are " +
                   known);
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(nullptr, nullptr);
  try {
    return run(argc, argv);
  } catch (const UsageError& error) {
    std::cerr << "spidartrack: " << error.what() << "; see spidartrack --help\n";
    return kWrongUsage;
  } catch (const std::exception& error) {
    std::cerr << "spidartrack: " << error.what() << '\n';
    return kFailed;
  }
}
