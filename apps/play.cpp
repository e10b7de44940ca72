// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Plays a video whose motion is felt, then prints a report. examples/play.sh builds it and finds a
/// video.

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gst/gst.h>

#include "apps/film/film_uri.h"
#include "apps/play/pipeline.h"
#include "apps/play/playback.h"
#include "apps/play/properties.h"
#include "apps/play/report.h"
#include "apps/play/session_record.h"
#include "apps/play/shown_frames.h"
#include "apps/play/trace_reader.h"

namespace fs = std::filesystem;

namespace {

constexpr const char* kUsage =
    "usage: play [--output FOLDER] [--verbose] VIDEO | URI | --ball [-- name=value ...]\n"
    "  --output FOLDER  where spidar-play.png goes; else the current folder\n"
    "  --seconds N      stop after N seconds\n"
    "  --verbose        end with a table and all fields of the element's stats, too\n"
    "  --headless       no window for the video, even with a display\n"
    "  --window         the debug window: tracks, forces, grip, settings\n"
    "  --window-png FILE  the same, saved as a picture after five seconds of the video, or at\n"
    "                   its end\n"
    "  name=value       properties of spidarmotion: gst-inspect-1.0 spidarmotion\n"
    "  --ball           no video, but the ball of videotestsrc for ten seconds\n";

struct Options {
  std::string video;
  fs::path output = ".";
  bool help = false;
  bool ball = false;
  int seconds = 0;  ///< 0: to the end
  bool verbose = false;
  bool headless = false;
  bool window = false;
  std::string window_png;
  std::vector<std::string> assignments;
};

/// Throws std::invalid_argument.
int whole_seconds(const std::string& text) {
  constexpr size_t kMostDigits = 5;
  const bool is_number = !text.empty() && text.size() <= kMostDigits &&
                         text.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number || std::stoi(text) == 0) {
    throw std::invalid_argument("--seconds needs a whole number from 1 to 99999, not '" + text +
                                "'");
  }
  return std::stoi(text);
}

/// Throws std::invalid_argument.
Options parse(const std::vector<std::string>& arguments) {
  Options options;
  for (size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--") {
      options.assignments.assign(arguments.begin() + static_cast<ptrdiff_t>(i) + 1,
                                 arguments.end());
      break;
    }
    if (argument == "--help" || argument == "-h") {
      options.help = true;
    } else if (argument == "--ball") {
      options.ball = true;
    } else if (argument == "--verbose") {
      options.verbose = true;
    } else if (argument == "--headless") {
      options.headless = true;
    } else if (argument == "--window") {
      options.window = true;
    } else if (argument == "--window-png" && i + 1 < arguments.size()) {
      options.window = true;
      options.window_png = arguments[++i];
    } else if (argument == "--seconds" && i + 1 < arguments.size()) {
      options.seconds = whole_seconds(arguments[++i]);
    } else if (argument == "--output" && i + 1 < arguments.size()) {
      options.output = arguments[++i];
    } else if (argument.size() > 1 && argument[0] == '-') {
      throw std::invalid_argument("unknown or incomplete option " + argument + "\n" + kUsage);
    } else if (!options.video.empty()) {
      throw std::invalid_argument("one video at a time, not " + options.video + " and " + argument +
                                  "; properties go after --\n" + kUsage);
    } else {
      options.video = argument;
    }
  }
  if (!options.help && options.ball == !options.video.empty()) {
    throw std::invalid_argument(std::string("give a video, or --ball\n") + kUsage);
  }
  return options;
}

/// A folder for pipes and curves that is removed when the object is destroyed.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string path = fs::temp_directory_path() / "spidar-play-XXXXXX";
    if (mkdtemp(path.data()) == nullptr) throw std::runtime_error(path + ": cannot be made");
    path_ = path;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Sets a path property of the filter and returns the value that the user had set.
std::string exchange_path(GstElement* filter, const char* property, const std::string& path) {
  char* old = nullptr;
  g_object_get(filter, property, &old, nullptr);
  const std::string result = old != nullptr ? old : "";
  g_free(old);
  g_object_set(filter, property, path.c_str(), nullptr);
  return result;
}

/// Saves the debug window once, when enough of the video has been played for its plots to be full.
class WindowPicture {
 public:
  WindowPicture(GstElement* filter, const std::string& path) : filter_(filter), path_(path) {}

  void take_if_due(int64_t running_ns) {
    constexpr int64_t kDue_ns = 5'000'000'000;
    if (running_ns >= kDue_ns) take();
  }

  /// At the end of a shorter video, too.
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

std::string progress_line(const Now& now) {
  constexpr int kBar = 20;
  constexpr double kFullBar_N = 3.0;
  const double force_N = std::hypot(now.force_N[0], now.force_N[1], now.force_N[2]);
  const int filled = std::min(kBar, static_cast<int>(std::lround(kBar * force_N / kFullBar_N)));
  const std::string bar = std::string(static_cast<size_t>(filled), '=') +
                          std::string(static_cast<size_t>(kBar - filled), ' ');
  char line[160];
  std::snprintf(line, sizeof(line), "%7.1f s  %6.0f px/s  %5.2f N [%s] x %+.2f y %+.2f  device %s",
                1e-9 * static_cast<double>(now.running_ns), now.speed_px_s, force_N, bar.c_str(),
                now.force_N[0], now.force_N[1], now.device.c_str());
  return line;
}

/// Makes the folder, if necessary, before a film is played for it. Throws std::invalid_argument
/// when it cannot be written to.
void prepare_output(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && access(folder.c_str(), W_OK | X_OK) == 0) return;
  const std::string reason = error ? error.message() : std::strerror(errno);
  throw std::invalid_argument("--output " + folder.string() + ": " + reason +
                              "; give a folder that can be written to");
}

int play(const Options& options) {
  prepare_output(options.output);
  GstElement* const filter = GST_ELEMENT(gst_object_ref_sink(make_filter()));
  for (const std::string& assignment : options.assignments) set_property(filter, assignment);
  if (options.window) g_object_set(filter, "debug-window", TRUE, nullptr);
  const std::string uri = options.ball ? "" : film_uri(options.video);
  std::string title = options.ball ? "videotestsrc pattern=ball" : options.video;
  if (fs::path(title).has_filename()) title = fs::path(title).filename();
  const Screen screen = open_screen(options.headless);
  GstElement* const pipeline =
      options.ball ? make_ball(filter, screen) : make_player(uri, filter, screen);
  std::printf("playing %s%s\n", title.c_str(),
              screen.why_none.empty()
                  ? ""
                  : (", in real time but without a window: " + screen.why_none).c_str());

  const TemporaryFolder folder;
  SessionRecord record;
  const std::string motion_pipe = folder.path() / "motion";
  const std::string haptic_pipe = folder.path() / "haptic";
  TraceReader motion(motion_pipe, exchange_path(filter, "trace", motion_pipe),
                     SessionRecord::motion_columns(),
                     [&](const TraceReader::Fields& row) { record.add_motion(row); });
  TraceReader haptic(haptic_pipe, exchange_path(filter, "haptic-trace", haptic_pipe),
                     SessionRecord::haptic_columns(),
                     [&](const TraceReader::Fields& row) { record.add_haptic(row); });
  watch_shown_frames(screen.sink, [&](int64_t running_ns, int64_t monotonic_ns) {
    record.add_shown(running_ns, monotonic_ns);
  });

  WindowPicture window_picture(filter, options.window_png);
  const Ending ending = run_playback(pipeline, options.seconds, [&] {
    const Now now = record.now();
    window_picture.take_if_due(now.running_ns);
    return progress_line(now);
  });
  window_picture.take();
  GstStructure* stats = nullptr;
  double max_force_N = 0;
  g_object_get(filter, "stats", &stats, "max-force", &max_force_N, nullptr);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
  gst_object_unref(filter);
  motion.finish();
  haptic.finish();

  if (record.numbers().frames == 0) {
    gst_structure_free(stats);
    throw std::runtime_error(title + ": not one frame was played");
  }
  if (ending == Ending::kInterrupted) std::printf("stopped by the user\n");
  print_report(record.numbers(), stats, options.verbose);
  gst_structure_free(stats);

  const std::string png = options.output / "spidar-play.png";
  draw_report(record.numbers(), max_force_N, title, folder.path(), png);
  std::printf("picture: %s\n", png.c_str());
  return ending == Ending::kFailed ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // in step with errors, also when written to a file
  gst_init(nullptr, nullptr);
  try {
    const Options options = parse({argv + 1, argv + argc});
    if (!options.help) return play(options);
    std::fputs(kUsage, stdout);
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
