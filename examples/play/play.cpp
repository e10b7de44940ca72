// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Plays a video whose motion is felt, then prints a report. examples/play.sh builds this program
/// and finds a video.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

#include <gst/gst.h>

#include "examples/play/picture.h"
#include "examples/play/pipeline.h"
#include "examples/play/playback.h"
#include "examples/play/record.h"
#include "examples/play/report.h"
#include "plugin/programs/software_gl.h"
#include "plugin/programs/typed_property.h"
#include "plugin/tools/gnuplot.h"
#include "spidar/part_file.h"
#include "spidar/tools/command_line.h"
#include "spidar/whole_file.h"

namespace fs = std::filesystem;

namespace {

struct Options {
  std::string video;
  std::string output = ".";
  bool ball = false;
  int seconds = 0;  ///< 0: to the end
  bool verbose = false;
  bool headless = false;
  bool window = false;
  std::string window_png;
  std::vector<std::string> properties;
};

/// Throws std::invalid_argument when `word`, which comes before "--", looks like a property.
void expect_no_property(const std::string& word) {
  const bool is_property = word[0] != '-' && word.find('=') != std::string::npos &&
                           word.find("://") == std::string::npos && !fs::exists(word);
  if (!is_property) return;
  throw std::invalid_argument(
      word + ": there is no such video; properties follow --: play VIDEO -- " + word);
}

/// The arguments after "--" are properties, not options. Throws CLI::ParseError and
/// std::invalid_argument.
Options parse(CLI::App& app, int argc, char** argv) {
  Options options;
  app.name("play");
  app.add_option("VIDEO", options.video, "A file or a URI");
  CLI::Option* const ball = app.add_flag("--ball", options.ball,
                                         "No video, but the ball of videotestsrc for ten seconds");
  app.add_option("--output", options.output, "Folder of spidar-play.png, else the current one");
  app.add_option("--seconds", options.seconds, "Stop at this second of the video")
      ->check(CLI::Range(1, 99999));
  app.add_flag("--verbose", options.verbose, "End with all fields of the element's stats, too");
  app.add_flag("--headless", options.headless, "No window for the video, even with a display");
  app.add_flag("--window", options.window, "The debug window in place of a window for the video");
  app.add_option("--window-png", options.window_png,
                 "The same, saved as a picture after five seconds of the video, or at its end");
  app.footer(
      "After -- come properties of spidarmotion, NAME=VALUE (gst-inspect-1.0 spidarmotion), and\n"
      "preset=paper, film or gentle");
  char** const end =
      std::find_if(argv, argv + argc, [](const char* word) { return std::string(word) == "--"; });
  app.allow_extras();
  app.parse(static_cast<int>(end - argv), argv);
  for (const std::string& word : app.remaining()) expect_no_property(word);
  if (!app.remaining().empty()) throw CLI::ExtrasError(app.remaining());
  if (!options.video.empty()) expect_no_property(options.video);
  if (end != argv + argc) options.properties.assign(end + 1, argv + argc);
  if (options.video.empty() == (ball->count() == 0)) {
    throw CLI::RequiredError("one of VIDEO and --ball");
  }
  if (!options.window_png.empty()) options.window = true;
  return options;
}

/// Saves the debug window once, when enough of the video has been played for its plots to be full.
class WindowPicture {
 public:
  WindowPicture(GstElement* filter, const std::string& path) : filter_(filter), path_(path) {}

  void take_if_due(double time_s) {
    constexpr double kDue_s = 5;
    if (time_s >= kDue_s) take();
  }

  /// Also called at the end of a shorter video.
  void take() {
    if (path_.empty()) return;
    gboolean saved = FALSE;
    g_signal_emit_by_name(filter_, "save-window", path_.c_str(), &saved);
    std::printf("\n%s: %s\n", path_.c_str(), saved ? "saved" : "could not be saved");
    path_.clear();
  }

 private:
  GstElement* const filter_;
  std::string path_;
};

constexpr const char* kPicture = "spidar-play.png";
/// Only files of this program are replaced.
const spidar::PartFile::Replaces kOwn{true, "play.sh", false};

/// Makes the folder, if necessary, before a film is played. Throws std::invalid_argument when the
/// folder cannot be written to, and std::runtime_error when it has another picture.
void prepare_output(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && access(folder.c_str(), W_OK | X_OK) == 0) {
    const spidar::PartFile picture(folder / kPicture, kOwn);
    return;
  }
  const std::string reason = error ? error.message() : std::strerror(errno);
  throw std::invalid_argument("--output " + folder.string() + ": " + reason +
                              "; give a folder that can be written to");
}

gboolean print_field(GQuark name, const GValue* value, void*) {
  char* const text = gst_value_serialize(value);
  std::printf("  %-24s %s\n", g_quark_to_string(name), text ? text : "-");
  g_free(text);
  return TRUE;
}

void draw(const Record& record, const Options& options, const std::string& title,
          double max_force_N) {
  const std::string png = fs::path(options.output) / kPicture;
  spidar::PartFile picture(png, kOwn);
  spidar::tools::draw_with_gnuplot(picture_script(record, max_force_N, title), picture);
  picture.publish();
  std::printf("picture: %s\n", png.c_str());
}

/// Stops a pipeline, and releases it and its filter.
struct Playing {
  GstElement* const pipeline;
  GstElement* const filter;

  Playing(GstElement* with, GstElement* of) : pipeline(with), filter(of) {}
  ~Playing() {
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
    gst_object_unref(filter);
  }
  Playing(const Playing&) = delete;
  Playing& operator=(const Playing&) = delete;
};

/// Waits until the user closes the debug window, which still shows the end of the film, or presses
/// Ctrl-C. The window may seek back into the film, and pause it there.
void wait_for_window(const Playing& playing) {
  constexpr gulong kStep_us = 50'000;
  static volatile std::sig_atomic_t is_interrupted = 0;
  std::signal(SIGINT, [](int) { is_interrupted = 1; });
  std::puts("the film is over; close the debug window, or press Ctrl-C");
  gboolean is_open = TRUE;
  GstBus* const bus = gst_element_get_bus(playing.pipeline);
  while (is_open && !is_interrupted) {
    g_usleep(kStep_us);
    while (GstMessage* const message = gst_bus_pop(bus)) {
      if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_REQUEST_STATE) {
        set_requested_state(playing.pipeline, message);
      }
      gst_message_unref(message);
    }
    g_object_get(playing.filter, "debug-window", &is_open, nullptr);
  }
  gst_object_unref(bus);
}

/// Returns whether one of the properties determines what is drawn into the video.
bool set_properties(GstElement* filter, const Options& options) {
  g_object_set(filter, "device", "auto", nullptr);
  bool has_overlay = false;
  for (const std::string& text : options.properties) {
    spidar::set_typed(filter, text);
    has_overlay = has_overlay || text.rfind("overlay=", 0) == 0;
  }
  return has_overlay;
}

/// `changed` is printed where the video has a window.
int play(const Options& options, const std::string& changed) {
  if (!options.ball) spidar::note_read(options.video);
  prepare_output(options.output);
  GstElement* const filter = GST_ELEMENT(gst_object_ref_sink(make_filter()));
  const bool has_overlay = set_properties(filter, options);
  g_object_set(filter, "post-messages", TRUE, nullptr);
  if (options.window) g_object_set(filter, "debug-window", TRUE, nullptr);
  std::string title = options.ball ? "videotestsrc pattern=ball" : options.video;
  if (fs::path(title).has_filename()) title = fs::path(title).filename();
  const Screen screen = open_screen(options.headless, options.window);
  if (screen.why_none.empty() && !options.window && !changed.empty()) {
    std::printf("note: %s\n", changed.c_str());
  }
  GstElement* const pipeline =
      options.ball ? make_ball(filter, screen) : make_player(options.video, filter, screen);
  std::printf("playing %s%s\n", title.c_str(),
              screen.why_none.empty()
                  ? ""
                  : (", in real time but without a window: " + screen.why_none).c_str());

  const Playing playing{pipeline, filter};
  Record record;
  double now_s = 0;
  WindowPicture window_picture(filter, options.window_png);
  const auto stats_of_filter = [filter] {
    GstStructure* stats = nullptr;
    g_object_get(filter, "stats", &stats, nullptr);
    return std::unique_ptr<GstStructure, void (*)(GstStructure*)>(stats, gst_structure_free);
  };
  PlaybackWatch watch;
  watch.progress = [&] { return progress_line(now_s, record.shown_at(now_s)); };
  watch.is_wanted = [&] {
    gboolean is_open = TRUE;
    if (options.window) g_object_get(filter, "debug-window", &is_open, nullptr);
    return is_open != FALSE;
  };
  watch.on_motion = [&](const GstStructure* message) {
    const std::string before = record.track();
    record.add_frame(message);
    if (record.track() != before) std::printf("playing %s\n", record.track().c_str());
  };
  watch.on_device = [&](const GstStructure* message) {
    gboolean simulated = FALSE;
    gst_structure_get_boolean(message, "simulated", &simulated);
    // Without a device, the overlay must show the force. The debug window draws it itself.
    if (simulated && !has_overlay && !options.window) {
      gst_util_set_object_arg(G_OBJECT(filter), "overlay", "curve");
    }
  };
  watch.on_moment = [&](double time_s) {
    now_s = time_s;
    record.add_device(stats_of_filter().get(), time_s);
    window_picture.take_if_due(time_s);
  };
  const Ending ending =
      run_playback(pipeline, options.ball ? title : options.video, options.seconds, watch);
  window_picture.take();
  const auto stats = stats_of_filter();
  const uint64_t shown = frames_shown(screen);
  double max_force_N = 0;
  g_object_get(filter, "max-force", &max_force_N, nullptr);

  const bool has_rows = !record.frames().empty() || !record.devices().empty();
  if (record.frames().empty()) {
    throw std::runtime_error(title + ": not one frame was played");
  }
  if (ending == Ending::kInterrupted) std::printf("stopped by the user\n");
  std::printf("\n%s", report_text(record, stats.get(), shown).c_str());
  if (options.verbose) {
    std::printf("\nFields of `stats`:\n");
    gst_structure_foreach(stats.get(), print_field, nullptr);
  }
  if (has_rows) draw(record, options, title, max_force_N);
  const bool shows_window = options.window && options.window_png.empty();
  if (shows_window && ending == Ending::kEndOfVideo && isatty(STDIN_FILENO)) {
    wait_for_window(playing);
  }
  return ending == Ending::kFailed ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // in step with errors, also in a file
  constexpr int kMistake = 2;                // in the command line
  spidar::tools::mark_files(argc, argv);
  CLI::App app("Plays a video whose motion is felt, and ends with a report and a picture of it.");
  try {
    const Options options = parse(app, argc, argv);
    const std::string changed = spidar::avoid_software_gl();
    gst_init(nullptr, nullptr);
    return spidar::tools::status_after_printing("play", play(options, changed));
  } catch (const CLI::ParseError& error) {
    return spidar::tools::status_after_printing("play", app.exit(error) == 0 ? 0 : kMistake);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return kMistake;
  } catch (const spidar::tools::UsageError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return kMistake;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
