// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "examples/play/pipeline.h"

#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <glib.h>

namespace {

constexpr guint kForceFilters = 1 << 11;  // GstPlayFlags is not in a public header

GstElement* make(const char* factory) {
  GstElement* const element = gst_element_factory_make(factory, nullptr);
  if (element != nullptr) return element;
  throw std::runtime_error(std::string("GStreamer has no element ") + factory +
                           ": is gstreamer1.0-plugins-good installed?");
}

/// The first sink in a bin; borrowed, null if there is none.
GstElement* sink_in(GstElement* bin) {
  GValue item = G_VALUE_INIT;
  GstIterator* const sinks = gst_bin_iterate_sinks(GST_BIN(bin));
  GstElement* sink = nullptr;
  if (gst_iterator_next(sinks, &item) == GST_ITERATOR_OK) {
    sink = GST_ELEMENT(g_value_get_object(&item));
    g_value_unset(&item);
  }
  gst_iterator_free(sinks);
  return sink;
}

/// The sink that autovideosink has chosen, or null. autovideosink uses a fakesink when nothing else
/// works.
GstElement* chosen_sink(GstElement* autovideosink) {
  GstElement* sink = sink_in(autovideosink);
  if (sink == nullptr) return nullptr;
  if (std::strcmp(GST_OBJECT_NAME(gst_element_get_factory(sink)), "fakesink") == 0) return nullptr;
  // glimagesink is a bin, too.
  while (sink != nullptr && GST_IS_BIN(sink)) sink = sink_in(sink);
  return sink;
}

}  // namespace

Screen open_screen(bool headless, bool in_debug_window) {
  Screen screen;
  if (headless) {
    screen.why_none = "as asked for";
  } else if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) {
    screen.why_none = "neither DISPLAY nor WAYLAND_DISPLAY is set";
  } else if (!in_debug_window) {
    // An X server resets itself when its last client disconnects. That happens when autovideosink
    // closes the first sink that it tries, and the server is then not ready for the next one.
    for (int attempt = 0; attempt < 5; ++attempt) {
      screen.element = make("autovideosink");
      gst_element_set_state(screen.element, GST_STATE_READY);
      screen.sink = chosen_sink(screen.element);
      if (screen.sink != nullptr) return screen;
      gst_element_set_state(screen.element, GST_STATE_NULL);
      gst_object_unref(gst_object_ref_sink(screen.element));
    }
    screen.why_none = "no video sink can open the display";
  }
  screen.element = screen.sink = make("fakesink");
  g_object_set(screen.element, "sync", TRUE, "qos", TRUE, nullptr);
  return screen;
}

uint64_t frames_shown(const Screen& screen) {
  if (!g_object_class_find_property(G_OBJECT_GET_CLASS(screen.sink), "stats")) return 0;
  GstStructure* stats = nullptr;
  guint64 rendered = 0;
  g_object_get(screen.sink, "stats", &stats, nullptr);
  gst_structure_get_uint64(stats, "rendered", &rendered);
  gst_structure_free(stats);
  return rendered;
}

GstElement* make_filter() {
  GstElement* const filter = gst_element_factory_make("spidarmotion", nullptr);
  if (filter != nullptr) return filter;
  throw std::runtime_error(
      "GStreamer does not find the element spidarmotion: start with examples/play.sh, or set "
      "GST_PLUGIN_PATH to the folder of libgstspidar.so");
}

GstElement* make_player(const std::string& film, GstElement* filter, const Screen& screen) {
  GstElement* const player = make("playbin");
  guint flags = 0;
  g_object_get(player, "flags", &flags, nullptr);
  // Frames in graphics memory would bypass the filter.
  char* const uri = film.find("://") != std::string::npos
                        ? g_strdup(film.c_str())
                        : gst_filename_to_uri(film.c_str(), nullptr);
  g_object_set(player, "uri", uri, "video-filter", filter, "video-sink", screen.element, "flags",
               flags | kForceFilters, nullptr);
  g_free(uri);
  if (!screen.why_none.empty()) {
    GstElement* const silence = make("fakesink");
    g_object_set(silence, "sync", TRUE, nullptr);
    g_object_set(player, "audio-sink", silence, nullptr);
  }
  return player;
}

GstElement* make_ball(GstElement* filter, const Screen& screen) {
  GstElement* const pipeline = gst_pipeline_new(nullptr);
  GstElement* const source = make("videotestsrc");
  GstElement* const caps = make("capsfilter");
  GstElement* const before = make("videoconvert");
  GstElement* const queue = make("queue");
  GstElement* const after = make("videoconvert");
  gst_util_set_object_arg(G_OBJECT(source), "pattern", "ball");
  gst_util_set_object_arg(G_OBJECT(caps), "caps",
                          "video/x-raw, width=640, height=480, framerate=30/1");
  g_object_set(source, "num-buffers", 300, nullptr);
  g_object_set(queue, "max-size-buffers", 3u, nullptr);  // as in playbin
  gst_bin_add_many(GST_BIN(pipeline), source, caps, before, filter, queue, after, screen.element,
                   nullptr);
  gst_element_link_many(source, caps, before, filter, queue, after, screen.element, nullptr);
  return pipeline;
}
