// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What the user does to a debug window.
#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <cmath>
#include <imgui.h>

#include <GLFW/glfw3.h>

#include "plugin/window/debug_window.h"

namespace spidar {
namespace {

constexpr double kStep_s = 0.1, kZoom = 1.25;
constexpr double kLongerArrows = 1.25, kForceStep_N = 0.1;

DebugWindow& window_of(GLFWwindow* window) {
  return *static_cast<DebugWindow*>(glfwGetWindowUserPointer(window));
}

}  // namespace

/// Dear ImGui's own callbacks would speak to the context that is current, which may be that of
/// another window.
void DebugWindow::install_callbacks() {
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
    window_of(w).make_current();
    ImGui_ImplGlfw_KeyCallback(w, key, scancode, action, mods);
    if (action != GLFW_RELEASE && !ImGui::GetIO().WantTextInput) window_of(w).on_key(key);
  });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned character) {
    window_of(w).make_current();
    ImGui_ImplGlfw_CharCallback(w, character);
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int mods) {
    window_of(w).make_current();
    ImGui_ImplGlfw_MouseButtonCallback(w, button, action, mods);
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
    window_of(w).make_current();
    ImGui_ImplGlfw_ScrollCallback(w, x, y);
  });
#if IMGUI_VERSION_NUM >= 18700  // before, Dear ImGui asks for the place of the mouse itself
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    window_of(w).make_current();
    ImGui_ImplGlfw_CursorPosCallback(w, x, y);
  });
#endif
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int focused) {
    window_of(w).make_current();
    ImGui_ImplGlfw_WindowFocusCallback(w, focused);
  });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int entered) {
    window_of(w).make_current();
    ImGui_ImplGlfw_CursorEnterCallback(w, entered);
  });
}

void DebugWindow::on_key(int key) {
  switch (key) {
    case GLFW_KEY_SPACE:
      change("mute", state_.value("mute", 0) != 0 ? 0 : 1);
      break;
    case GLFW_KEY_LEFT:
      change("arrow-scale", state_.value("arrow-scale", 1) / kLongerArrows);
      break;
    case GLFW_KEY_RIGHT:
      change("arrow-scale", state_.value("arrow-scale", 1) * kLongerArrows);
      break;
    case GLFW_KEY_UP:
      change("max-force", state_.value("max-force", 0) + kForceStep_N);
      break;
    case GLFW_KEY_DOWN:
      change("max-force", state_.value("max-force", 0) - kForceStep_N);
      break;
    case GLFW_KEY_D:
      detail_ = !detail_;
      break;
    case GLFW_KEY_R:
      show_relief_ = !show_relief_;
      break;
    case GLFW_KEY_P:
      timeline_.is_paused() ? timeline_.resume() : timeline_.pause();
      break;
    case GLFW_KEY_COMMA:
      timeline_.look_at(timeline_.cursor_s() - kStep_s);
      break;
    case GLFW_KEY_PERIOD:
      timeline_.look_at(timeline_.cursor_s() + kStep_s);
      break;
    case GLFW_KEY_C:
      save_choices();
      break;
    case GLFW_KEY_S:
      save_wanted_ = true;
      break;
    case GLFW_KEY_H:
      help_ = !help_;
      break;
    case GLFW_KEY_Q:
      glfwSetWindowShouldClose(window_, GLFW_TRUE);
      break;
    default:
      break;
  }
}

/// Only a simulated device has a hand, and in the past nothing can be moved.
bool DebugWindow::offers_hand() const {
  return state_.device && state_.device->has_hand && !timeline_.is_paused();
}

/// While the picture is touched, and else when the mouse is in the picture.
bool DebugWindow::explains_hand(const FrameFacts& facts) const {
  return offers_hand() && (facts.touch.on || hand_.hand().is_over());
}

void DebugWindow::use_mouse(const Mouse& mouse, const Rect& picture, const FrameFacts& facts) {
  if (const auto wish = click_.update(mouse, timeline_.is_paused() ? Rect() : picture, facts)) {
    choose(*wish);
  }
  if (!offers_hand() || picture.width <= 0 || click_.holds()) {
    hand_.let_go();
    return;
  }
  const TouchMap map{GripPointer(state_.device->geometry), facts_.scene.turn};
  hand_.update(mouse, picture, map);
}

/// The wheel shows more or less of the last seconds, dragging moves them.
void DebugWindow::use_plots(const Mouse& mouse, const WindowLayout& layout) {
  const bool is_over =
      !mouse.taken && (layout.force.has(mouse.at_px) || layout.speed.has(mouse.at_px));
  if (is_over && mouse.wheel != 0) timeline_.zoom(std::pow(kZoom, -mouse.wheel));
  const bool begins = mouse.down && !plots_down_ && is_over;
  plots_down_ = mouse.down;
  if (!mouse.down) drag_px_.reset();
  if (begins) drag_px_ = mouse.at_px.x();
  if (!drag_px_ || !std::isfinite(mouse.at_px.x()) || mouse.at_px.x() == *drag_px_) return;
  const double moved = (mouse.at_px.x() - *drag_px_) / std::max(layout.force.width, 1.0);
  timeline_.look_at(timeline_.cursor_s() - moved * timeline_.plotted_s());
  drag_px_ = mouse.at_px.x();
}

}  // namespace spidar
