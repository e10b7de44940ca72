// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "examples/play/playback.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <map>
#include <unistd.h>
#include <vector>

#include <glib-unix.h>
#include <gst/pbutils/pbutils.h>

namespace {

constexpr guint kMoment_ms = 20;
/// The interval between two lines of progress: on a terminal, and in a file.
constexpr guint kProgress_ms = 100, kLoggedProgress_ms = 2000;

struct Playback {
  GstElement* pipeline;
  const std::string film;
  const int seconds;  ///< of the film to play; 0: all
  const PlaybackWatch& watch;
  bool on_terminal;
  GMainLoop* main_loop;
  Ending ending = Ending::kFailed;
  bool buffering = false;
  int unwanted = 0;                          ///< moments since the window was closed
  std::map<std::string, int> warnings = {};  ///< counts by text

  void stop(Ending why) {
    ending = why;
    g_main_loop_quit(main_loop);
  }

  /// Messages begin on a new line.
  void clear_line() const {
    if (on_terminal) std::printf("\r\033[K");
    std::fflush(stdout);
  }
};

/// Whether this playbin has found its streams and none of them is video.
bool has_no_video(GstElement* playbin) {
  if (!g_object_class_find_property(G_OBJECT_GET_CLASS(playbin), "n-video")) return false;
  int count = 0;
  g_object_get(playbin, "n-video", &count, nullptr);
  return count == 0;
}

/// Whether the film is shorter than its container says.
bool ends_early(GstElement* pipeline) {
  constexpr gint64 kMuch_ns = 1'000'000'000;  // streams of a film end at slightly different times
  gint64 position = 0, duration = 0;
  return gst_element_query_position(pipeline, GST_FORMAT_TIME, &position) &&
         gst_element_query_duration(pipeline, GST_FORMAT_TIME, &duration) &&
         position + kMuch_ns < duration;
}

/// The last line of GStreamer's debug text has the reason; the lines before it state the place in
/// the source.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

void end_by_error(Playback& playback, GstMessage* message) {
  GError* error = nullptr;
  char* debug = nullptr;
  gst_message_parse_error(message, &error, &debug);
  playback.clear_line();
  const bool window_closed =
      GST_OBJECT_FLAG_IS_SET(message->src, GST_ELEMENT_FLAG_SINK) &&
      g_error_matches(error, GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_NOT_FOUND);
  playback.stop(window_closed ? Ending::kInterrupted : Ending::kFailed);
  // GStreamer does not always say that a host does not answer.
  const bool is_remote = playback.film.find("://") != std::string::npos;
  std::fprintf(stderr, "%s: %s: %s (%s)%s\n", window_closed ? "note" : "error",
               playback.film.c_str(), error->message, last_line(debug ? debug : "").c_str(),
               is_remote && !window_closed ? "; does its host answer?" : "");
  g_error_free(error);
  g_free(debug);
}

void end_by_end(Playback& playback) {
  if (ends_early(playback.pipeline)) {
    playback.clear_line();
    std::fprintf(stderr, "warning: the film is shorter than it says: it seems to be cut off\n");
  }
  playback.stop(Ending::kEndOfVideo);
}

/// A broken video warns at every frame; each text is printed once.
void report_warning(Playback& playback, GstMessage* message) {
  GError* error = nullptr;
  gst_message_parse_warning(message, &error, nullptr);
  const std::string text = std::string(GST_OBJECT_NAME(message->src)) + ": " + error->message;
  g_error_free(error);
  if (++playback.warnings[text] > 1) return;
  playback.clear_line();
  std::fprintf(stderr, "warning: %s\n", text.c_str());
}

/// For example, the device cannot render everything.
void report_information(const Playback& playback, GstMessage* message) {
  GError* information = nullptr;
  gst_message_parse_info(message, &information, nullptr);
  playback.clear_line();
  std::fprintf(stderr, "note: %s\n", information->message);
  g_error_free(information);
}

void report_missing_plugin(const Playback& playback, GstMessage* message) {
  char* const what = gst_missing_plugin_message_get_description(message);
  playback.clear_line();
  std::fprintf(stderr, "warning: not installed: %s\n", what);
  g_free(what);
}

/// A network stream pauses until enough data have arrived.
void follow_buffering(Playback& playback, GstMessage* message) {
  int percent = 0;
  gst_message_parse_buffering(message, &percent);
  const bool buffering = percent < 100;
  if (buffering == playback.buffering) return;
  playback.buffering = buffering;
  gst_element_set_state(playback.pipeline, buffering ? GST_STATE_PAUSED : GST_STATE_PLAYING);
}

gboolean on_message(GstBus*, GstMessage* message, void* data) {
  auto& playback = *static_cast<Playback*>(data);
  switch (GST_MESSAGE_TYPE(message)) {
    case GST_MESSAGE_ERROR:
      end_by_error(playback, message);
      break;
    case GST_MESSAGE_WARNING:
      report_warning(playback, message);
      break;
    case GST_MESSAGE_INFO:
      report_information(playback, message);
      break;
    case GST_MESSAGE_EOS:
      end_by_end(playback);
      break;
    case GST_MESSAGE_ASYNC_DONE:
      if (has_no_video(playback.pipeline)) {
        std::fprintf(stderr, "error: %s: there is no video in it\n", playback.film.c_str());
        playback.stop(Ending::kFailed);
      }
      break;
    case GST_MESSAGE_BUFFERING:
      follow_buffering(playback, message);
      break;
    case GST_MESSAGE_CLOCK_LOST:
      gst_element_set_state(playback.pipeline, GST_STATE_PAUSED);
      gst_element_set_state(playback.pipeline, GST_STATE_PLAYING);
      break;
    case GST_MESSAGE_REQUEST_STATE:
      set_requested_state(playback.pipeline, message);
      break;
    case GST_MESSAGE_LATENCY:
      gst_bin_recalculate_latency(GST_BIN(playback.pipeline));
      break;
    case GST_MESSAGE_ELEMENT:
      if (gst_is_missing_plugin_message(message)) report_missing_plugin(playback, message);
      if (gst_message_has_name(message, "spidar-motion")) {
        playback.watch.on_motion(gst_message_get_structure(message));
      }
      if (gst_message_has_name(message, "spidar-device")) {
        playback.watch.on_device(gst_message_get_structure(message));
      }
      break;
    default:
      break;
  }
  return G_SOURCE_CONTINUE;
}

gboolean on_signal(void* data) {
  static_cast<Playback*>(data)->stop(Ending::kInterrupted);
  return G_SOURCE_CONTINUE;
}

/// Whether the window of the user has failed; then the video continues without it.
bool has_warned_of_window(const Playback& playback) {
  return std::any_of(playback.warnings.begin(), playback.warnings.end(), [](const auto& warning) {
    return warning.first.find("debug window") != std::string::npos;
  });
}

/// Whether the film has reached this second, which it does not in a pause or while data are
/// missing.
bool is_over(const Playback& playback) {
  gint64 position_ns = 0;
  return playback.seconds > 0 &&
         gst_element_query_position(playback.pipeline, GST_FORMAT_TIME, &position_ns) &&
         position_ns >= playback.seconds * static_cast<gint64>(GST_SECOND);
}

gboolean on_moment(void* data) {
  auto& playback = *static_cast<Playback*>(data);
  if (is_over(playback)) playback.stop(Ending::kEndOfVideo);
  // By then, the warning has been read.
  constexpr int kMoments = 5;
  playback.unwanted = playback.watch.is_wanted() ? 0 : playback.unwanted + 1;
  if (playback.unwanted > kMoments && !has_warned_of_window(playback)) {
    playback.stop(Ending::kInterrupted);
  }
  const GstClockTime running = gst_element_get_current_running_time(playback.pipeline);
  if (GST_STATE(playback.pipeline) == GST_STATE_PLAYING && running != GST_CLOCK_TIME_NONE) {
    playback.watch.on_moment(1e-9 * static_cast<double>(running));
  }
  return G_SOURCE_CONTINUE;
}

gboolean on_progress(void* data) {
  const auto& playback = *static_cast<Playback*>(data);
  playback.clear_line();
  std::printf("%s%s", playback.watch.progress().c_str(), playback.on_terminal ? "" : "\n");
  std::fflush(stdout);
  return G_SOURCE_CONTINUE;
}

}  // namespace

void set_requested_state(GstElement* pipeline, GstMessage* message) {
  GstState state = GST_STATE_PLAYING;
  gst_message_parse_request_state(message, &state);
  gst_element_set_state(pipeline, state);
}

Ending run_playback(GstElement* pipeline, const std::string& film, int seconds,
                    const PlaybackWatch& watch) {
  gst_pb_utils_init();
  const bool on_terminal = isatty(STDOUT_FILENO) != 0;
  Playback playback{pipeline, film, seconds, watch, on_terminal, g_main_loop_new(nullptr, FALSE)};

  GstBus* const bus = gst_element_get_bus(pipeline);
  gst_bus_add_watch(bus, on_message, &playback);
  std::vector<guint> sources = {
      g_unix_signal_add(SIGINT, on_signal, &playback),
      g_unix_signal_add(SIGTERM, on_signal, &playback),
      g_timeout_add(kMoment_ms, on_moment, &playback),
      g_timeout_add(on_terminal ? kProgress_ms : kLoggedProgress_ms, on_progress, &playback),
  };

  // On failure, the bus has a message with the reason.
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  g_main_loop_run(playback.main_loop);

  for (const guint source : sources) g_source_remove(source);
  gst_bus_remove_watch(bus);
  gst_object_unref(bus);
  g_main_loop_unref(playback.main_loop);
  playback.clear_line();
  for (const auto& [text, count] : playback.warnings) {
    if (count > 1) std::fprintf(stderr, "warning: %s (%d times in all)\n", text.c_str(), count);
  }
  return playback.ending;
}
