// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What the user does to a debug window.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <imgui.h>
#include <limits>

#include <GLFW/glfw3.h>

#include "plugin/window/program/debug_window.h"

namespace spidar {
namespace {

constexpr double kStep_s = 0.1, kZoom = 1.25;
constexpr double kLongerArrows = 1.25, kForceStep_N = 0.1;

}  // namespace

Mouse read_mouse() {
  const ImGuiIO& io = ImGui::GetIO();
  Mouse mouse;
  mouse.at_px = {io.MousePos.x, io.MousePos.y};
  if (!ImGui::IsMousePosValid()) {
    mouse.at_px.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  mouse.down = io.MouseDown[0];
  mouse.shift = io.KeyShift;
  mouse.wheel = io.MouseWheel;
  mouse.taken = io.WantCaptureMouse;
  return mouse;
}

void DebugWindow::take(const UserInput& input) {
  if (input.key) on_key(*input.key);
  if (input.mouse) given_mouse_ = input.mouse;
  if (input.size_px) {
    glfwSetWindowSize(window_, static_cast<int>(input.size_px->x()),
                      static_cast<int>(input.size_px->y()));
  }
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

/// What a click does, until the user has clicked once; then only how deep the hand is.
std::string DebugWindow::hint(const FrameFacts& facts) const {
  if (hand_.holds() && facts.touch.on) {
    char text[96];
    std::snprintf(text, sizeof text, "Hand %.1f mm %s. Wheel or Shift+drag: away or near",
                  std::fabs(1e3 * hand_.z_m()), hand_.z_m() > 0 ? "near" : "away");
    return text;
  }
  if (has_clicked_ || timeline_.is_paused()) return {};
  const char* const choosing = "A click on an object has it felt in this scene. ";
  const char* const leading = "The left button, held in the picture, moves the simulated hand.";
  return std::string(offers_choice(facts) && !facts.scene.objects.empty() ? choosing : "") +
         (offers_hand() ? leading : "");
}

void DebugWindow::use_mouse(const Mouse& mouse, const Rect& picture, const FrameFacts& facts) {
  has_clicked_ = has_clicked_ || (mouse.down && !mouse.taken && picture.has(mouse.at_px));
  if (const auto wish = click_.update(mouse, timeline_.is_paused() ? Rect() : picture, facts)) {
    choose(*wish);
  }
  if (!offers_hand() || picture.width <= 0 || click_.holds()) {
    hand_.let_go();
    return link_.lead_hand(std::nullopt);
  }
  const TouchMap map{GripPointer(state_.device->geometry), facts.scene.turn};
  link_.lead_hand(hand_.update(mouse, picture, map));
}

/// The wheel shows more or less of the last seconds.
void DebugWindow::use_plots(const Mouse& mouse, const WindowLayout& layout) {
  const bool is_over =
      !mouse.taken && (layout.force.has(mouse.at_px) || layout.speed.has(mouse.at_px));
  if (is_over && mouse.wheel != 0) timeline_.zoom(std::pow(kZoom, -mouse.wheel));
}

}  // namespace spidar
