// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The window of a build without GLFW or Dear ImGui.
#include "plugin/window/window.h"

namespace spidar {

struct Window::Entry {};

std::string write_png(const Screenshot&, const std::string&) {
  return "built without the debug window";
}

bool windows_are_built_in() {
  return false;
}

Window::Window(std::shared_ptr<WindowSource> source, std::shared_ptr<FrameFeed>) {
  source->warn("This build has no debug window.",
               "Install GLFW and Dear ImGui (libglfw3-dev, libimgui-dev) and build again.");
}

Window::~Window() = default;

std::optional<Screenshot> Window::screenshot(std::chrono::milliseconds) {
  return std::nullopt;
}

void Window::resize(int, int) {}

void Window::press(int) {}

void Window::set_mouse(const Mouse&) {}

}  // namespace spidar
