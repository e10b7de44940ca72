// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/screen/screen.h"

#include <csignal>
#include <exception>
#include <memory>
#include <stdexcept>

#include <glib-unix.h>

#include "plugin/feel/follow/felt_element.h"
#include "plugin/feel/screen/felt_screen.h"
#include "plugin/feel/screen/view.h"

namespace spidar::screen {
namespace {

constexpr guint kTick_ms = 250;

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
    follow::tell("looks at " + view->name());
    Watch watch{loop, &felt};
    const guint timer = g_timeout_add(kTick_ms, tick, &watch);
    g_main_loop_run(loop);
    g_source_remove(timer);
    g_main_loop_unref(loop);
    return 0;
  } catch (const std::exception& error) {
    follow::tell(error.what());
    return 1;
  }
}

}  // namespace spidar::screen
