// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The commands of spidartrack. Each takes its own command line, in which argv[0] is its name, and
/// returns the exit status. They throw UsageError and std::runtime_error.
#pragma once

namespace spidar {

int analyze_film_command(int argc, char** argv);
int check_track_command(int argc, char** argv);
int convert_track_command(int argc, char** argv);
int join_pieces_command(int argc, char** argv);
int plot_track_command(int argc, char** argv);
int record_track_command(int argc, char** argv);
int render_track_command(int argc, char** argv);
int track_info_command(int argc, char** argv);

}  // namespace spidar
