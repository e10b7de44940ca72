// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Haptic tracks: records, looks at, checks, converts, draws and merges them.

#include <vector>

#include <gst/gst.h>

#include "plugin/tools/spidartrack_commands.h"
#include "spidar/tools/command_line.h"

namespace {

using namespace spidar;

const std::vector<Command> kCommands = {
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

}  // namespace

int main(int argc, char** argv) {
  gst_init(nullptr, nullptr);
  return run_program("spidartrack", kCommands, kHelp, argc, argv);
}
