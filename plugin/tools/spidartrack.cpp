// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Records, inspects, checks, converts and plots haptic tracks.

#include <algorithm>
#include <iostream>
#include <pthread.h>
#include <string>
#include <system_error>
#include <vector>

#include <gst/gst.h>

#include "plugin/tools/processors.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tracks/part_file.h"
#include "spidar/realtime/standard_descriptors.h"
#include "spidar/tools/cli_program.h"

namespace {

using namespace spidar;

/// The command line. Of each command, run() is called when it is parsed.
class CommandLine {
 public:
  CommandLine() {
    app_.set_help_flag("-h,--help", "Explain the program, or a command, and end");
    app_.set_version_flag("--version", "spidartrack " SPIDAR_VERSION);
    app_.require_subcommand(1);
    app_.footer("spidartrack COMMAND --help explains a command.");
    add_record();
    add_info();
    add_check();
    add_convert();
    add_plot();
  }
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// Throws CLI::ParseError, and what a command throws.
  int run(int argc, char** argv) {
    char** const end = argv + argc;
    // What follows "--" are properties, not options.
    char** const dashes = argc > 1 && std::string(argv[1]) == "record"
                              ? std::find(argv + 1, end, std::string("--"))
                              : end;
    properties_.assign(std::min(dashes + 1, end), end);
    check_command(app_, argc, argv);
    app_.parse(static_cast<int>(dashes - argv), argv);
    return status_;
  }
  const CLI::App& program() const { return app_; }

 private:
  CLI::App* add(const char* name, const char* description, int (CommandLine::*command)()) {
    CLI::App* const added = app_.add_subcommand(name, description);
    added->callback([this, command] { status_ = (this->*command)(); });
    return added;
  }

  void add_record() {
    CLI::App* const app = add("record", "record the haptic tracks of films, into files beside them",
                              &CommandLine::record);
    record_.jobs = usable_processors();
    app->footer(
        "Analyses films, or all films in a folder and below, the largest first, as fast as they "
        "can\n"
        "be decoded, and writes the haptic track of FILM.mp4 beside it, as FILM.mp4.haptic.flac. "
        "A\n"
        "track that is there is left alone, so that the command goes on where it was interrupted; "
        "if\n"
        "it is that of another film, or was recorded with other properties, that is an error.\n"
        "Properties of spidarmotion that change the force follow --: -- motion=camera max-force=2");
    app->add_option("FILM", films_, "films, and folders of films")->required();
    app->add_option("-j,--jobs", record_.jobs, "films at a time; as many as processors may be used")
        ->check(number(1, 1024));
    app->add_option("--folder", record_.folder,
                    "where tracks are written, those of a folder in the same subfolders");
    app->add_option("--format", record_.format, "flac (24 bits), mka or wav (both F32)")
        ->check(CLI::IsMember({"flac", "mka", "wav"}));
    app->add_option(
        "--manifest", record_.manifest,
        "a file that gets a line of JSON for each film: result, duration, felt share …");
    app->add_flag("--force", record_.force, "also those that are there");
  }
  int record() {
    set_films(record_, films_, properties_);
    return record_films(record_);
  }

  void add_info() {
    CLI::App* const app = add("info", "print the length and size of a track", &CommandLine::info);
    app->footer(
        "Of a film: whether a haptic track is inside it or beside it, and belongs to it; then as "
        "of\n"
        "the track: how long it is, and how large: largest force and torque, steepest change, "
        "peak\n"
        "and mean square of each channel in shares of the full scale (10 N, 1 N m), and how much "
        "of\n"
        "its energy is above 30 Hz.");
    app->add_option("TRACK", info_.path, "a track, or a film")->required();
    app->add_flag("--json", info_.json, "as JSON");
  }
  int info() { return print_info(info_); }

  void add_check() {
    CLI::App* const app =
        add("check", "report what in a track cannot be felt as it is", &CommandLine::check);
    app->footer(
        "Whether nothing is missing at its end, all samples are numbers, none is beyond full "
        "scale,\n"
        "and force and torque stay below the limits and change no faster than 300 N/s; and how "
        "much\n"
        "of it is felt. What a device gives is within its limits in any case. A tenth of the "
        "energy\n"
        "of a channel above 30 Hz is no motion of a film. Exit status 1, and a line for each "
        "thing\n"
        "that is wrong.");
    app->add_option("TRACK", check_.track)->required();
    app->add_option("--max-force", check_.max_force_N, "in N; 3 as of spidarsink")
        ->check(number(0, 20, " N"));
    app->add_option("--max-torque", check_.max_torque_Nm, "in N m; 0.1 as of spidarsink")
        ->check(number(0, 1, " N m"));
  }
  int check() { return check_track(check_); }

  void add_convert() {
    CLI::App* const app = add("convert", "convert between FLAC, Matroska, WAV, HJIF and funscript",
                              &CommandLine::convert);
    app->footer(
        "FROM is a track in FLAC, Matroska, WAV or another container, in HJIF (.hjif), or a\n"
        "funscript. TO is what its name ends in: .flac, .mka, .wav, .hjif, .ahap (a vibration for\n"
        "telephones) or .funscript; a file of this name is replaced\n"
        "when the new one is complete. What TO cannot hold is printed.");
    app->add_option("FROM", convert_.from)->required();
    app->add_option("TO", convert_.to)->required();
    app->add_option("--axis", convert_.axis, "of a funscript, and with --rate; fy")
        ->check(CLI::IsMember({"fx", "fy", "fz", "tx", "ty", "tz"}));
    app->add_option("--rate", convert_.save.rate_Hz,
                    "sound with this channel alone, in Hz, as for a bass shaker: 48000")
        ->check(number(1000, 192000, " Hz"));
    app->add_option("--gain", convert_.gain,
                    "of a funscript, AHAP and sound with --rate; so much that the largest value of "
                    "the track fills the range")
        ->check(number(1e-3, 1e6));
    app->add_option("--tolerance", convert_.save.tolerance,
                    "share of the full scale by which curves may differ between their points: HJIF "
                    "0.0004, AHAP 0.02, funscript 0.01")
        ->check(number(0, 1));
  }
  int convert() { return convert_track(convert_); }

  void add_plot() {
    CLI::App* const app = add("plot", "draw a picture of a track", &CommandLine::plot);
    app->footer("Draws force and torque over time. Needs gnuplot.");
    app->add_option("TRACK", plot_.track)->required();
    app->add_option("PNG", plot_.png)->required();
    app->add_option("--film", plot_.film,
                    "draws stills of the film above, each over the moment it shows, which a dotted "
                    "line marks");
  }
  int plot() { return plot_track(plot_); }

  CLI::App app_{"Records, inspects, checks, converts and plots haptic tracks.", "spidartrack"};
  RecordOptions record_;
  std::vector<std::string> films_, properties_;
  InfoOptions info_;
  CheckOptions check_;
  ConvertOptions convert_;
  PlotOptions plot_;
  int status_ = kDone;
};

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
  CommandLine line;
  return exit_status_of(line.program(), [&] { return line.run(argc, argv); });
}
