// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Records, inspects, checks, converts, plots and shows haptic tracks.

#include <algorithm>
#include <functional>
#include <iostream>
#include <pthread.h>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <gst/gst.h>

#include "core/default_limits.h"
#include "plugin/programs/own_plugins.h"
#include "plugin/tools/film_process.h"
#include "plugin/tools/spidartrack_commands.h"
#include "plugin/tracks/sidecar.h"
#include "spidar/part_file.h"
#include "spidar/realtime/processors.h"
#include "spidar/realtime/standard_descriptors.h"
#include "spidar/tools/cli_program.h"
#include "spidar/tools/command_line.h"

namespace {

using namespace spidar;
using namespace spidar::tools;

/// The command line. The run() of each command is called when the command is parsed.
class CommandLine {
 public:
  /// `descriptors` is the number of descriptors that the program may have open.
  explicit CommandLine(rlim_t descriptors) : descriptors_(descriptors) {
    app_.set_help_flag("-h,--help", "Explain the program or the command, and end");
    app_.set_version_flag("--version", "spidartrack " SPIDAR_VERSION, "Print the version, and end");
    app_.require_subcommand(1);
    app_.footer("spidartrack COMMAND --help explains a command.");
    add_record();
    add_info();
    add_check();
    add_convert();
    add_plot();
    add_show();
    add_export();
  }
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// Throws CLI::ParseError, and the exceptions of the commands.
  int run(int argc, char** argv) {
    char** const end = argv + argc;
    // The arguments after "--" are properties, not options.
    const std::string command = argc > 1 ? argv[1] : "";
    char** const dashes = command == "record" || command == "show" || command == "export"
                              ? std::find(argv + 1, end, std::string("--"))
                              : end;
    properties_.assign(std::min(dashes + 1, end), end);
    check_command(app_, argc, argv);
    app_.parse(static_cast<int>(dashes - argv), argv);
    return status_;
  }
  const CLI::App& program() const { return app_; }

 private:
  CLI::App* add(const char* name, const char* description, std::function<int()> command) {
    CLI::App* const added = app_.add_subcommand(name, description);
    added->callback([this, command = std::move(command)] {
      search_folder();
      status_ = command();
    });
    return added;
  }

  void add_record() {
    CLI::App* const app = add("record", "analyse films and write their haptic tracks beside them",
                              [this] { return record(); });
    record_.jobs = usable_processors();
    app->footer(
        R"(Writes the haptic track of FILM.mp4 as FILM.mp4.haptic.flac, as fast as the film can be
decoded. A folder stands for all films in it and below it, the largest first.

A film that has a track is left out, so that a command that was interrupted goes on when it
is given again. A track of another film, or one that was recorded with other properties, is
an error; --force replaces it.

Properties of spidarmotion that change the force, and preset=NAME, come last, after two dashes:
  spidartrack record FILM.mp4 -- motion=camera max-force=2)");
    app->add_option("FILM", films_, "films, and folders of films")->required()->type_name("");
    app->add_option("-j,--jobs", record_.jobs,
                    "how many films at a time; default: as many as processors may be used")
        ->check(number(1, 1024))
        ->type_name("N");
    app->add_option(
           "--folder", record_.folder,
           "the folder that tracks are written into; films in subfolders get the same ones")
        ->type_name("FOLDER");
    app->add_option("--format", record_.format,
                    "flac (24 bits, the default), mka or wav (both 32-bit floating point)")
        ->check(CLI::IsMember({"flac", "mka", "wav"}))
        ->type_name("FORMAT");
    app->add_option("--manifest", record_.manifest,
                    "append a line of JSON to this file for each film: the result of processing "
                    "it, and what "
                    "is in its track")
        ->type_name("FILE");
    app->add_flag("--force", record_.force, "record films again that have a track, and replace it");
    app->add_option("-o,--output", to_)->group("");  // as in other programs
  }
  int record() {
    if (!to_.empty()) refuse_output(films_.front(), to_);
    // Each film needs its part file, two sockets for its process, and one descriptor while a file
    // or folder beside it is read. The others are for the manifest and the libraries.
    constexpr rlim_t kOfFilm = 4, kOthers = 32;
    const rlim_t films = std::max(descriptors_, kOthers + kOfFilm) - kOthers;
    record_.jobs = static_cast<unsigned>(std::min<rlim_t>(record_.jobs, films / kOfFilm));
    set_films(record_, films_, properties_);
    return record_films(record_);
  }

  void add_track(CLI::App* app, const char* name, std::string& path) {
    app->add_option(name, path, "a haptic track, or a film with one inside it or beside it")
        ->required()
        ->type_name("");
    add_track_folder(app);
  }

  void add_track_folder(CLI::App* app) {
    app->add_option("--folder", track_folder_,
                    std::string("a folder with tracks of films, as record --folder fills it; else "
                                "those of the variable ") +
                        kTrackPathVariable)
        ->check(CLI::ExistingDirectory)
        ->type_name("FOLDER");
  }

  /// Adds the folder to kTrackPathVariable, for every search of a track.
  void search_folder() const {
    if (track_folder_.empty()) return;
    const char* const others = secure_getenv(kTrackPathVariable);
    g_setenv(kTrackPathVariable,
             (track_folder_ + (others ? std::string(":") + others : "")).c_str(), TRUE);
  }

  /// For commands that write one file.
  static void add_force(CLI::App* app, const std::string& what, bool& force) {
    app->add_flag("--force", force,
                  "replace " + what +
                      ", whatever it is; without this, a file that is there is replaced only if "
                      "this command wrote it and nobody has changed it since");
  }

  void add_info() {
    CLI::App* const app = add("info", "print how long and how strong a track is",
                              [this] { return print_info(track_, json_); });
    app->footer(
        R"(Prints the length of the track, its largest force and torque and their steepest change; and
of each channel the peak and the root mean square, in N and N m, and the fraction of its energy
above 30 Hz. With --json, peak and root mean square are fractions of full_scale, which is 10 N or 1 N m. Of a film, also where its track is, and whether it
is that of this film.)");
    add_track(app, "TRACK", track_);
    app->add_flag("--json", json_, "print it as JSON");
  }

  void add_check() {
    CLI::App* const app = add("check", "report what in a track cannot be felt as it is",
                              [this] { return check_track(track_, max_force_N_, max_torque_Nm_); });
    app->footer(
        R"(Reports a track that is cut off, samples that are not numbers or beyond the full scale, force
and torque above the limits, force that changes by more than 300 N/s, a channel with more than
a tenth of its energy above 30 Hz, which is no motion of a film, and a track in which nothing
is felt. The exit status is then 1. Playing such a track is safe: a device keeps its limits
in any case. Also prints how much of the track is felt.)");
    add_track(app, "TRACK", track_);
    app->add_option("--max-force", max_force_N_,
                    "largest force, in N; default: 3, as spidarsink has")
        ->check(number(0, 20, " N"))
        ->type_name("N");
    app->add_option("--max-torque", max_torque_Nm_, "largest torque, in N m; default: 0.1")
        ->check(number(0, 1, " N m"))
        ->type_name("NM");
  }

  void add_convert() {
    CLI::App* const app = add("convert", "convert a track into another format",
                              [this] { return convert_track(convert_); });
    app->footer(R"(The formats follow from how the names end:
  .flac .mka .wav  sound of six channels; also read from other containers and from films
  .hjif            MPEG's format for haptics
  .funscript       one channel as the positions of a linear device; read with its other axes,
                   in it and in .roll.funscript and so on beside it
  .ahap            a vibration as strong as the force, for telephones; not read
  .csv             time_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm; read at any times, with some of them
Prints what TO cannot hold.)");
    add_track(app, "FROM", convert_.from);
    app->add_option("TO", convert_.to, "the file to write")->required()->type_name("");
    add_force(app, "TO", convert_.force);
    app->add_option(
           "--axis", convert_.axis,
           "the channel of a funscript: fx, fy, fz, tx, ty or tz; default: that with the most "
           "motion, and all that it has when one is read; all: six files, .surge .sway .twist "
           ".roll .pitch.funscript and TO for the strongest")
        ->check(CLI::IsMember({"fx", "fy", "fz", "tx", "ty", "tz", kAllAxes}))
        ->type_name("CHANNEL");
    app->add_option("--gain", convert_.gain,
                    "factor for a funscript or AHAP; default: the largest value of the "
                    "track fills the range. Of a funscript that is read, the one that it was "
                    "written with; default: as it says, else 100 % is 3 N or 0.1 N m")
        ->check(number(kMinGain, kMaxGain))
        ->type_name("FACTOR");
    app->add_option("--tolerance", convert_.save.tolerance,
                    "largest error of curves, as a fraction of the full scale; default: 0.0004 for "
                    "HJIF, 0.02 for AHAP, 0.01 for a funscript")
        ->check(number(0, 1))
        ->type_name("SHARE");
  }

  void add_plot() {
    CLI::App* const app = add("plot", "draw force and torque over time",
                              [this] { return plot_track(track_, png_, force_); });
    app->footer("Needs gnuplot.");
    add_track(app, "TRACK", track_);
    app->add_option("PNG", png_, "the picture to write")->required()->type_name("");
    add_force(app, "PNG", force_);
  }

  void add_show() {
    CLI::App* const app =
        add("show", "make a film with its force drawn into it", [this] { return show(); });
    app->footer(
        R"(Analyses FILM, and writes a film of its pictures, sound and subtitles into which are drawn
the outlines of objects, the force as an arrow with its newtons, and the curve of the force over the last
five seconds.

Properties of spidarmotion that change the force, and preset=NAME, come last, after two dashes:
  spidartrack show FILM.mp4 SHOWN.mp4 -- motion=camera)");
    app->add_option("FILM", film_, "a film")->required()->type_name("");
    app->add_option("TO", to_, "the film to write; its name ends in .mp4 or .mkv")
        ->required()
        ->type_name("");
    app->add_flag(
        "--subtitles", draws_subtitles_,
        "draw the first subtitles into the pictures, in place of keeping all beside them");
    add_force(app, "TO", force_);
    app->add_option("PROPERTY", misplaced_)->group("");
  }
  int show() {
    refuse_misplaced("show FILM TO");
    return show_film(film_, to_, force_, draws_subtitles_,
                     with_rules(parse_record_properties(properties_, 1), film_));
  }

  /// Throws for properties before the dashes, and for unknown words.
  void refuse_misplaced(const std::string& command) const {
    for (const std::string& word : misplaced_) expect_no_property(word, command);
    if (!misplaced_.empty()) throw CLI::ExtrasError(misplaced_);
  }

  void add_export() {
    CLI::App* const app = add("export", "make a web page that plays a film with its force",
                              [this] { return export_page(); });
    app->footer(
        R"(The page plays FILM with an arrow and a curve of the force, and vibrates a gamepad, or a
telephone. It needs no network. The force is that of the track of FILM; if it has none, FILM is
analysed, as record does it.

A page PAGE.html plays FILM from where it is, and has less than 100 KB; with --embed, the film
is in it. A folder FOLDER/ gets the page, index.html, and the film. There and with --embed, a
film that not every browser plays becomes H.264 and AAC in MP4.

Properties of spidarmotion that change the force, and preset=NAME, come last, after two dashes;
FILM is then analysed with them:
  spidartrack export FILM.mp4 PAGE.html -- max-force=2)");
    app->add_option("FILM", export_.film, "a film")->required()->type_name("");
    app->add_option("TO", export_.to,
                    "the page to write, whose name ends in .html, or a folder, which ends in /")
        ->required()
        ->type_name("");
    app->add_flag("--embed", export_.embed, "put the film into the page");
    app->add_option("--track", export_.track, "the track of FILM")->type_name("TRACK");
    add_track_folder(app);
    add_force(app, "TO", export_.force);
    app->add_option("PROPERTY", misplaced_)->group("");
  }
  int export_page() {
    refuse_misplaced("export FILM TO");
    if (!properties_.empty() && !export_.track.empty()) {
      throw UsageError("--track and properties exclude each other: a track is not analysed");
    }
    if (!properties_.empty()) export_.properties = parse_record_properties(properties_, 1);
    return export_film(export_);
  }

  const rlim_t descriptors_;
  CLI::App app_{"Records, inspects, checks, converts, plots and shows haptic tracks.",
                "spidartrack"};
  RecordOptions record_;
  std::vector<std::string> films_, properties_, misplaced_;
  std::string track_folder_;
  // Used by info, check, plot and show.
  std::string track_, png_, film_, to_;
  bool json_ = false, force_ = false, draws_subtitles_ = false;
  double max_force_N_ = kDefaultForce_N, max_torque_Nm_ = kDefaultTorque_Nm;  ///< of spidarsink
  ConvertOptions convert_;
  ExportOptions export_;
  int status_ = kDone;
};

/// GStreamer reads and writes files in threads that need more stack than the 128 KiB of musl's
/// default, or than a low limit.
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
  const rlim_t descriptors = raise_descriptor_limit();
  request_stacks();
  const int film_status = run_film_process(argc, argv);
  if (film_status >= 0) return film_status;
  mark_files(argc, argv);
  try {
    remove_part_files_on_signals();
  } catch (const std::system_error& error) {
    std::cerr << "spidartrack: the system gives it no thread: " << error.what() << '\n';
    return kFailed;
  }
  gst_init(nullptr, nullptr);
  find_own_plugins({"spidar"});  // commands that need it report the error
  CommandLine line(descriptors);
  return exit_status_of(line.program(), [&] { return line.run(argc, argv); });
}
