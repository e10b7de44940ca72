// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Records, inspects, checks, converts and plots haptic tracks.

#include <iostream>
#include <pthread.h>
#include <system_error>
#include <vector>

#include <gst/gst.h>

#include "plugin/tools/spidartrack_commands.h"
#include "plugin/track/part_file.h"
#include "spidar/realtime/standard_descriptors.h"
#include "spidar/tools/command_line.h"
#include "spidar/tools/exit_status.h"

namespace {

using namespace spidar;

const std::vector<Command> kCommands = {
    {"record", record_track_command}, {"info", track_info_command},
    {"check", check_track_command},   {"convert", convert_track_command},
    {"plot", plot_track_command},
};

constexpr const char* kSpidartrackHelp = R"(usage: spidartrack COMMAND

  record   record the haptic tracks of films, into files beside them
  info     print the length and size of a track
  check    report what in a track cannot be felt as it is
  convert  convert between FLAC, Matroska, WAV, HJIF, traces and funscript
  plot     draw a picture of a track
  --help
  --version

spidartrack COMMAND --help explains a command.
)";

/// GStreamer reads and writes files in threads for which the 128 KiB that musl gives by default, or
/// a low limit of the stack, are not enough.
void request_stacks() {
  constexpr size_t kEnough_bytes = size_t{1} << 20;
  pthread_attr_t attributes;
  size_t given_bytes = 0;
  if (pthread_getattr_default_np(&attributes) != 0) return;
  pthread_attr_getstacksize(&attributes, &given_bytes);
  if (given_bytes < kEnough_bytes) {
    pthread_attr_setstacksize(&attributes, kEnough_bytes);
    pthread_setattr_default_np(&attributes);
  }
  pthread_attr_destroy(&attributes);
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_descriptors();
  request_stacks();
  try {
    remove_part_files_on_signals();
  } catch (const std::system_error& error) {
    std::cerr << "spidartrack: the system gives it no thread: " << error.what() << '\n';
    return kFailed;
  }
  gst_init(nullptr, nullptr);
  return run_program("spidartrack", kCommands, kSpidartrackHelp, argc, argv);
}
