// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A simple player without any knowledge of haptics, which controls playbin or a decoder according
// to its arguments.
//
// feel-player PLAYBIN FILM STEP...: PLAYBIN is playbin, playbin3, or one of the decoders of
// decoder_player.h. Steps are
//   own-filter, own-sink    sets a video-filter, or a sink with spidarmotion device=none, of its
//   own; own-filter needs playbin
//   window                  uses a sink that accepts what a window accepts, without a converter;
//   needs playbin
//   refuse                  lets its sink refuse all caps from now on; needs a decoder
//   slow-pads               takes its time with each new pad from now on; needs a decoder
//   preroll, play, pause, ready, stop
//   seek                    to the beginning
//   other                   uses a second player from now on
//   frames=N, wait=MS       waits until N more frames were shown; for MS milliseconds
//   end                     waits for the end of the film, and prints how many frames were shown
//   and a checksum of them loaded                  prints whether the plugin is in this process
//   stay                    waits for ever
//   exit                    exits without stopping
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <unistd.h>

#include <gst/gst.h>

#include "tests/emulated_bus/bus_state.h"
#include "tests/pipelines/decoder_player.h"

namespace {

std::atomic<int> frames_shown{0};

GChecksum* checksum = nullptr;

/// Called in the streaming thread; `checksum` is read when it has come to its end.
void shown(GstElement*, GstBuffer* frame, GstPad*, gpointer) {
  ++frames_shown;
  const GstClockTime time = GST_BUFFER_PTS(frame);
  g_checksum_update(checksum, reinterpret_cast<const guchar*>(&time), sizeof time);
  GstMapInfo bytes;
  if (!gst_buffer_map(frame, &bytes, GST_MAP_READ)) return;
  g_checksum_update(checksum, bytes.data, static_cast<gssize>(bytes.size));
  gst_buffer_unmap(frame, &bytes);
}

/// Shows every frame, also late ones.
void watch(GstElement* sink) {
  g_object_set(sink, "sync", TRUE, "qos", FALSE, "max-lateness", gint64{-1}, "signal-handoffs",
               TRUE, nullptr);
  g_signal_connect(sink, "handoff", G_CALLBACK(shown), nullptr);
}

bool is_playbin(const std::string& name) {
  return name.rfind("playbin", 0) == 0;
}

GstElement* make_player(const char* playbin, const std::string& film) {
  GstElement* sink = nullptr;
  if (!is_playbin(playbin)) {
    GstElement* player = spidar::test::make_decoder_player(playbin, film, &sink);
    watch(sink);
    return player;
  }
  GstElement* player = gst_element_factory_make(playbin, nullptr);
  sink = gst_element_factory_make("fakesink", nullptr);
  watch(sink);
  gchar* uri = gst_filename_to_uri(film.c_str(), nullptr);
  g_object_set(player, "uri", uri, "video-sink", sink, nullptr);
  g_free(uri);
  return player;
}

/// As a window: a format that graphics cards overlay, and no conversion by playbin itself. It is
/// one that decoders of 10 bits have in their templates, too: playbin refuses a decoder none of
/// whose formats the sink takes.
void show_in_window(GstElement* player) {
  // Of GstPlayFlags, which is no public type. Without the others playbin has no reason to convert.
  constexpr guint kVideo = 1 << 0, kNativeVideo = 1 << 6;
  GstElement* sink = nullptr;
  g_object_get(player, "video-sink", &sink, nullptr);
  GstElement* window = gst_bin_new("window");
  GstElement* format = gst_element_factory_make("capsfilter", nullptr);
  gst_util_set_object_arg(G_OBJECT(format), "caps", "video/x-raw,format=I420");
  gst_bin_add_many(GST_BIN(window), format, sink, nullptr);
  gst_element_link(format, sink);
  GstPad* pad = gst_element_get_static_pad(format, "sink");
  gst_element_add_pad(window, gst_ghost_pad_new("sink", pad));
  gst_object_unref(pad);
  g_object_set(player, "flags", kVideo | kNativeVideo, "video-sink", window, nullptr);
  gst_object_unref(sink);
}

/// Ends the program when the player fails.
void set_state(GstElement* player, GstState state) {
  gst_element_set_state(player, state);
  if (gst_element_get_state(player, nullptr, nullptr, GST_CLOCK_TIME_NONE) !=
      GST_STATE_CHANGE_FAILURE)
    return;
  std::fputs("the player fails\n", stderr);
  std::exit(1);
}

void wait_for_frames(int frames) {
  const int until = frames_shown + frames;
  while (frames_shown < until) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void wait_for_end(GstElement* player) {
  GstBus* bus = gst_element_get_bus(player);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
    std::fputs("the player fails\n", stderr);
    std::exit(1);
  }
  gst_message_unref(message);
  gst_object_unref(bus);
  std::printf("%d frames, %s\n", frames_shown.load(), g_checksum_get_string(checksum));
}

bool is_loaded() {
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (line.find("libgstspidarfeel.so") != std::string::npos) return true;
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  spidar::test::bus();  // or the linker leaves it out
  gst_init(nullptr, nullptr);
  if (argc < 3) return 2;
  checksum = g_checksum_new(G_CHECKSUM_MD5);
  GstElement* players[] = {make_player(argv[1], argv[2]), make_player(argv[1], argv[2])};
  size_t now = 0;
  for (int i = 3; i < argc; ++i) {
    const std::string step = argv[i];
    const std::string name = step.substr(0, step.find('='));
    const int number = name == step ? 0 : std::atoi(step.c_str() + name.size() + 1);
    GstElement* player = players[now];
    const std::map<std::string, GstState> states{{"preroll", GST_STATE_PAUSED},
                                                 {"play", GST_STATE_PLAYING},
                                                 {"pause", GST_STATE_PAUSED},
                                                 {"ready", GST_STATE_READY},
                                                 {"stop", GST_STATE_NULL}};
    if (states.count(name)) {
      set_state(player, states.at(name));
    } else if (name == "own-filter") {
      g_object_set(player, "video-filter", gst_element_factory_make("identity", nullptr), nullptr);
    } else if (name == "window") {
      show_in_window(player);
    } else if (name == "own-sink" && !is_playbin(argv[1])) {
      spidar::test::add_own_motion(player);
    } else if (name == "own-sink") {
      g_object_set(
          player, "video-sink",
          gst_parse_bin_from_description(
              "videoconvert ! spidarmotion device=none ! fakesink sync=true", TRUE, nullptr),
          nullptr);
    } else if (name == "refuse") {
      spidar::test::refuse_caps(player);
    } else if (name == "slow-pads") {
      spidar::test::take_time_with_pads(player);
    } else if (name == "seek") {
      gst_element_seek_simple(player, GST_FORMAT_TIME, GST_SEEK_FLAG_FLUSH, 0);
    } else if (name == "end") {
      wait_for_end(player);
    } else if (name == "other") {
      now = 1;
    } else if (name == "frames") {
      wait_for_frames(number);
    } else if (name == "wait") {
      std::this_thread::sleep_for(std::chrono::milliseconds(number));
    } else if (name == "loaded") {
      std::puts(is_loaded() ? "loaded" : "not loaded");
    } else if (name == "stay") {
      for (;;) pause();
    } else if (name == "exit") {
      std::exit(0);
    } else {
      std::fprintf(stderr, "%s: no such step\n", argv[i]);
      return 2;
    }
  }
  for (GstElement* player : players) {
    gst_element_set_state(player, GST_STATE_NULL);
    gst_object_unref(player);
  }
  g_checksum_free(checksum);
  return 0;
}
