// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/screen/screen.h"

#include <csignal>
#include <exception>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include <glib-unix.h>

#include "plugin/feel/follow/felt_element.h"
#include "plugin/feel/screen/view.h"
#include "plugin/gobject/ref.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::screen {
namespace {

constexpr guint kTick_ms = 250;

/// A shorter state is not reported: a cut, a film that pauses briefly.
constexpr int64_t kBrief_ns = 2'000'000'000;

constexpr const char *kUnknown = "area-unknown", *kNoFilm = "no-film",
                     *kResting = "repeated-frames";

std::string text_in(const GstStructure* structure, const char* name) {
  const char* const text = gst_structure_get_string(structure, name);
  return text ? text : "";
}

/// Captures a view, analyses it and renders its force. One thread.
class FeltScreen {
 public:
  /// `properties` are those of spidarmotion, NAME=VALUE. Opens the device and begins. Without a
  /// device, the debug window shows the force. Throws std::runtime_error, which says what is wrong.
  FeltScreen(View& view, const std::vector<std::string>& properties)
      : view_(view),
        // Keep only the newest picture. Nothing is converted if spidarmotion accepts its format.
        pipeline_(follow::parse_pipeline(
            "queue name=newest leaky=downstream max-size-buffers=1 max-size-bytes=0 "
            "max-size-time=0 "
            "! videoconvert ! spidarmotion name=felt ! fakesink sync=false")) {
    GstBin* const bin = GST_BIN(pipeline_);
    felt_ = Ref<GstElement>(gst_bin_get_by_name(bin, "felt")).get();
    follow::set_properties(felt_, properties);
    // Some sources bring a clock of their own.
    const Ref<GstClock> clock(gst_system_clock_obtain());
    gst_pipeline_use_clock(GST_PIPELINE(pipeline_), clock.get());
    const Ref<GstElement> newest(gst_bin_get_by_name(bin, "newest"));
    GstElement* const source = view_.make_source().release();
    gst_bin_add(bin, source);
    gst_object_unref(source);  // the bin owns it from now on
    if (!gst_element_link(source, newest.get())) {
      throw std::runtime_error("the source has no video");
    }
    gst_element_set_state(pipeline_, GST_STATE_READY);
    read_messages();  // sets is_simulated_
    if (is_simulated_ && !follow::wants_window(properties) && follow::has_display()) {
      g_object_set(felt_, "debug-window", TRUE, nullptr);
    }
    gst_element_set_state(pipeline_, GST_STATE_PLAYING);
  }
  ~FeltScreen() {
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    gst_object_unref(pipeline_);
  }
  FeltScreen(const FeltScreen&) = delete;
  FeltScreen& operator=(const FeltScreen&) = delete;

  /// Prints changes. Call this a few times a second. Returns false when the view has ended.
  bool check() {
    if (!read_messages()) return false;
    const std::string change = view_.change();
    if (!change.empty()) follow::print_message(change);
    if (view_.has_ended()) return false;
    if (view_.is_shown()) update_remarks();
    return true;
  }

 private:
  /// A remark that is printed when it has been true for a while, and again after other remarks.
  struct Remark {
    std::string text;
    int64_t since_ns = 0;
    bool is_due = false;
  };

  bool read_messages() {
    const Ref<GstBus> bus(gst_element_get_bus(pipeline_));
    while (GstMessage* const message = gst_bus_pop(bus.get())) {
      const std::string text = follow::text_for_people(message);
      if (!text.empty() && printed_.insert(text).second) follow::print_message(text);
      is_simulated_ = follow::parse_is_simulated(message).value_or(is_simulated_);
      const bool is_over = GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR ||
                           GST_MESSAGE_TYPE(message) == GST_MESSAGE_EOS;
      gst_message_unref(message);
      if (is_over) return false;
    }
    return true;
  }

  void update_remark(Remark& last, const std::string& text) {
    const int64_t now_ns = monotonic_now_ns();
    if (text != last.text) last = {text, now_ns, !text.empty()};
    if (!last.is_due || now_ns - last.since_ns < kBrief_ns) return;
    last.is_due = false;
    if (std::exchange(last_remark_, text) != text) follow::print_message(text);
  }

  /// Returns an empty string while the film is unknown.
  std::string film_text(const GstStructure* stats) const {
    const Ref<GstPad> pad(gst_element_get_static_pad(felt_, "sink"));
    const Ref<GstCaps> caps(gst_pad_get_current_caps(pad.get()));
    gint width = 0, height = 0;
    if (caps) {
      const GstStructure* const format = gst_caps_get_structure(caps.get(), 0);
      gst_structure_get(format, "width", G_TYPE_INT, &width, "height", G_TYPE_INT, &height,
                        nullptr);
    }
    guint x = 0, y = 0, film_width = 0, film_height = 0;
    gst_structure_get(stats, "area-x", G_TYPE_UINT, &x, "area-y", G_TYPE_UINT, &y, "area-width",
                      G_TYPE_UINT, &film_width, "area-height", G_TYPE_UINT, &film_height, nullptr);
    const std::string reason = text_in(stats, "no-force-reason");
    if (width == 0 || film_width == 0 || reason == kUnknown || reason == kNoFilm) return "";
    const bool is_all =
        static_cast<guint>(width) == film_width && static_cast<guint>(height) == film_height;
    const std::string size = std::to_string(film_width) + " x " + std::to_string(film_height);
    if (!is_all) {
      return "a film is in it, " + size + " at " + std::to_string(x) + ", " + std::to_string(y);
    }
    if (reason == kResting) return "";
    return "no film with something at rest around it is seen: all of it is felt, " + size;
  }

  void update_remarks() {
    GstStructure* stats = nullptr;
    g_object_get(felt_, "stats", &stats, nullptr);
    update_remark(film_, film_text(stats));
    const std::string device = text_in(stats, "device-no-force-text");
    std::string film = text_in(stats, "no-force-text");
    if (text_in(stats, "no-force-reason") == kResting) {
      film += " Protected video is captured black.";
    }
    update_remark(reason_, device.empty() ? film : device);
    gst_structure_free(stats);
  }

  View& view_;
  GstElement* pipeline_;
  GstElement* felt_ = nullptr;  ///< owned by the pipeline
  bool is_simulated_ = false;
  std::set<std::string> printed_;  ///< printed messages
  std::string last_remark_;        ///< the last remark
  Remark film_;                    ///< on the position of the film
  Remark reason_;                  ///< on why nothing is felt
};

struct Watch {
  GMainLoop* loop;
  FeltScreen* felt;
};

bool is_wayland() {
  const char* const display = g_getenv("WAYLAND_DISPLAY");
  return display && *display;
}

/// Only the desktop sees the windows of Wayland.
std::unique_ptr<View> choose_view(const std::string& what) {
  if (!is_wayland()) {
#ifdef SPIDAR_HAS_X11
    return view_of_x11(what);
#else
    throw std::runtime_error(
        "this spidar-feel was built without X11: build it with libx11-dev and -Dwindow=enabled");
#endif
  }
  if (what.empty() || what == "ask") return view_of_portal(!what.empty());
  throw std::runtime_error(
      "on Wayland, programs do not know the titles of windows: the desktop asks for the window "
      "with spidar-feel --screen=ask");
}

gboolean tick(gpointer user) {
  const auto& watch = *static_cast<Watch*>(user);
  if (!watch.felt->check()) g_main_loop_quit(watch.loop);
  return G_SOURCE_CONTINUE;
}

gboolean quit(gpointer loop) {
  g_main_loop_quit(static_cast<GMainLoop*>(loop));
  return G_SOURCE_CONTINUE;
}

}  // namespace

int run(const std::string& what, const std::vector<std::string>& properties) {
  try {
    const std::unique_ptr<View> view = choose_view(what);
    FeltScreen felt(*view, properties);
    GMainLoop* const loop = g_main_loop_new(nullptr, FALSE);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) g_unix_signal_add(number, quit, loop);
    follow::print_message("looks at " + view->name());
    Watch watch{loop, &felt};
    const guint timer = g_timeout_add(kTick_ms, tick, &watch);
    g_main_loop_run(loop);
    g_source_remove(timer);
    g_main_loop_unref(loop);
    return 0;
  } catch (const std::exception& error) {
    follow::print_message(error.what());
    return 1;
  }
}

}  // namespace spidar::screen
