// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The commands of spidartrack. Each takes its own command line, in which argv[0] is its name, and
/// returns the exit status. They throw UsageError and std::runtime_error.
#pragma once

namespace spidar {

int check_track_command(int argc, char** argv);
int convert_track_command(int argc, char** argv);
int plot_track_command(int argc, char** argv);
int record_track_command(int argc, char** argv);
int track_info_command(int argc, char** argv);

}  // namespace spidar
