// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The debug window of one element, which starts this program with a socket as standard input.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <GLFW/glfw3.h>
#include <gst/gst.h>

#include "plugin/window/program/debug_window.h"
#include "plugin/window/program/player_link.h"

namespace spidar::window {
namespace {

using std::chrono::milliseconds;

/// A player may be stopped in a debugger; the window continues to draw.
constexpr milliseconds kFrameTimeout{100};
/// For the first answer, without which the window has no name.
constexpr milliseconds kFirstFrameTimeout{5000};
constexpr int kFallbackRate_Hz = 60;

std::chrono::steady_clock::duration screen_period() {
  GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* const mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  const int rate_Hz = mode && mode->refreshRate > 0 ? mode->refreshRate : kFallbackRate_Hz;
  return std::chrono::nanoseconds(1'000'000'000 / rate_Hz);
}

std::string glfw_error() {
  const char* why = nullptr;
  glfwGetError(&why);
  return why ? why : "unknown reason";
}

void draw_until_closed(DebugWindow& window, PlayerLink& link) {
  const std::chrono::steady_clock::duration period = screen_period();
  while (!link.is_over() && !window.is_done()) {
    const std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
    glfwPollEvents();
    for (const UserInput& input : link.take_inputs()) window.process(input);
    // This comes after the last request, so that the picture contains everything sent before.
    const std::optional<std::string> picture = link.wanted_picture();
    if (!picture) link.request_frame(kFrameTimeout);
    window.draw();
    if (picture) link.picture_taken(window.save(*picture));
    window.present();
    // With software rendering, leave half of the time to other programs.
    const std::chrono::steady_clock::time_point end = std::chrono::steady_clock::now();
    const std::chrono::steady_clock::duration left = std::max(begin + period - end, end - begin);
    link.pause(std::chrono::duration_cast<milliseconds>(left));
  }
}

/// Returns the status of the program. The player reports errors on its bus.
int show(PlayerLink& link) {
  link.request_frame(kFirstFrameTimeout);
  if (link.is_over()) return link.is_incompatible() ? EXIT_FAILURE : EXIT_SUCCESS;
  if (!glfwInit()) {
    link.cannot_open("The debug window cannot be opened: " + glfw_error() +
                         ". Is DISPLAY or WAYLAND_DISPLAY right?",
                     "It needs an X11 or Wayland display.");
    return EXIT_FAILURE;
  }
  try {
    DebugWindow window(link);
    draw_until_closed(window, link);
  } catch (const std::runtime_error& error) {
    link.cannot_open(
        std::string("The debug window cannot be opened with OpenGL 3.3: ") + error.what() + ".",
        "Is there a driver for it, or Mesa's software renderer (libgl1-mesa-dri)?");
    return EXIT_FAILURE;
  }
  glfwTerminate();
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace spidar::window

int main() {
  int kind = 0;
  socklen_t size = sizeof kind;
  if (getsockopt(STDIN_FILENO, SOL_SOCKET, SO_TYPE, &kind, &size) != 0 || kind != SOCK_STREAM) {
    std::fputs("spidar-window: spidarmotion debug-window=true starts this program.\n", stderr);
    return EXIT_FAILURE;
  }
  // The output of a driver must not mix with that of the player.
  dup2(STDERR_FILENO, STDOUT_FILENO);
  // Drawing yields to decoding.
  setpriority(PRIO_PROCESS, 0, 10);
  // GStreamer's library converts pictures; its plugins are not needed.
  setenv("GST_REGISTRY_DISABLE", "yes", 1);
  gst_init(nullptr, nullptr);
  spidar::window::PlayerLink link(STDIN_FILENO);
  return spidar::window::show(link);
}
