// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/**
 * SECTION:tracer-spidarfeel
 * @title: spidarfeel
 * @short_description: lets the videos of any player be felt
 *
 * Adds a video-filter with #spidarmotion to every playbin and playbin3 that shows video and has no
 * video-filter. The program spidar-feel runs a player with this tracer. The environment variable
 * `SPIDAR_FEEL` has properties of #spidarmotion, one NAME=VALUE per line.
 *
 * The device is opened when a video begins to play, not before, and closed when it is stopped.
 *
 * Since: 0.1
 */
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <unistd.h>

#define GST_USE_UNSTABLE_API
#include <gst/gst.h>
#include <gst/gsttracer.h>

#include "plugin/feel/tracer/feel_bin.h"
#include "plugin/gobject/ref.h"

#define GST_TYPE_SPIDAR_FEEL_TRACER (gst_spidar_feel_tracer_get_type())
G_DECLARE_FINAL_TYPE(GstSpidarFeelTracer, gst_spidar_feel_tracer, GST, SPIDAR_FEEL_TRACER,
                     GstTracer)
struct _GstSpidarFeelTracer {
  GstTracer parent;
};

G_DEFINE_TYPE(GstSpidarFeelTracer, gst_spidar_feel_tracer, GST_TYPE_TRACER)

static constexpr guint kPlayVideo = 1;  // a value of GstPlayFlags, which is no public type

static bool is_playbin(GstElement* element) {
  GstElementFactory* factory = gst_element_get_factory(element);
  const char* name = factory ? GST_OBJECT_NAME(factory) : nullptr;
  return g_strcmp0(name, "playbin") == 0 || g_strcmp0(name, "playbin3") == 0;
}

/// Whether spidar-feel FILM runs the player of GStreamer itself.
static bool is_own_player() {
  return g_strcmp0(g_get_prgname(), "gst-play-1.0") == 0;
}

static void set_filter(GstElement* element) {
  GstElement* before = nullptr;
  guint flags = 0;
  g_object_get(element, "video-filter", &before, "flags", &flags, nullptr);
  const spidar::Ref<GstElement> own(before);
  // The filter is the application's own, or that of this tracer for the previous film.
  if (own || (flags & kPlayVideo) == 0) return;
  GstElement* filter =
      gst_spidar_feel_bin_new(secure_getenv(SPIDAR_FEEL_VARIABLE), is_own_player());
  if (filter) g_object_set(element, "video-filter", filter, nullptr);
}

/// Prints, once, that there is no video: when a playbin begins to play and its filter is still
/// without a parent.
static void print_no_video(GstElement* element) {
  static std::atomic<bool> has_printed{false};
  GstElement* filter = nullptr;
  g_object_get(element, "video-filter", &filter, nullptr);
  const spidar::Ref<GstElement> own(filter);
  if (!own || !GST_IS_SPIDAR_FEEL_BIN(filter)) return;
  const spidar::Ref<GstObject> parent(gst_object_get_parent(GST_OBJECT(filter)));
  if (parent || has_printed.exchange(true)) return;
  g_printerr(
      "spidar-feel: there is no video in it, so nothing is felt; a haptic track is played by "
      "spidarsink\n");
}

/// GStreamer calls this for every element, in any thread: it returns at once except for players.
static void before_state_change(GstTracer*, GstClockTime, GstElement* element,
                                GstStateChange transition) {
  if (transition == GST_STATE_CHANGE_READY_TO_PAUSED && is_playbin(element)) set_filter(element);
  if (transition == GST_STATE_CHANGE_PAUSED_TO_PLAYING && is_playbin(element)) {
    print_no_video(element);
  }
}

static std::atomic<bool> has_failed{false};

/// Replaces the status of gst-play-1.0, which is 0 even if it cannot play the film.
static void end_with_status() {
  if (!has_failed) return;
  std::fflush(nullptr);
  _exit(1);
}

/// An error of an element in a player counts only when the playbin itself reports it.
static void before_message(GstTracer*, GstClockTime, GstElement* element, GstMessage* message) {
  if (GST_MESSAGE_TYPE(message) != GST_MESSAGE_ERROR || !is_playbin(element)) return;
  has_failed = has_failed || is_own_player();
}

static void gst_spidar_feel_tracer_init(GstSpidarFeelTracer* self) {
  std::atexit(end_with_status);
  gst_tracing_register_hook(GST_TRACER(self), "element-post-message-pre",
                            G_CALLBACK(before_message));
  gst_tracing_register_hook(GST_TRACER(self), "element-change-state-pre",
                            G_CALLBACK(before_state_change));
}

static void gst_spidar_feel_tracer_class_init(GstSpidarFeelTracerClass*) {}

static gboolean gst_spidar_feel_tracer_register(GstPlugin* plugin) {
  return gst_tracer_register(plugin, "spidarfeel", GST_TYPE_SPIDAR_FEEL_TRACER);
}

// The tracer is a plugin of its own, so that GStreamer loads it only for spidar-feel.
#define PACKAGE "gst-spidar"
GST_PLUGIN_DEFINE(GST_VERSION_MAJOR, GST_VERSION_MINOR, spidarfeel,
                  "Lets the videos of any GStreamer player be felt",
                  gst_spidar_feel_tracer_register, PACKAGE_VERSION, "LGPL", "gst-spidar",
                  "https://journal.icter.org/index.php/ICTer/article/view/155")
