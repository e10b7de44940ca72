// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The user's input to a debug window, and choices of objects in the picture.
#include <cmath>
#include <imgui.h>
#include <limits>

#include <GLFW/glfw3.h>

#include "plugin/window/program/debug_window.h"
#include "spidar/text.h"

namespace spidar::window {
namespace {

constexpr double kZoom = 1.25;
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

void DebugWindow::process(const UserInput& input) {
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
    case GLFW_KEY_H:
      keys_ = !keys_;
      break;
    case GLFW_KEY_P:
      toggle_play();
      break;
    case GLFW_KEY_1:
    case GLFW_KEY_2:
      use_settings(static_cast<size_t>(key - GLFW_KEY_1));
      break;
    case GLFW_KEY_C:
      save_choices(&SceneChoices::has_unsaved);
      break;
    case GLFW_KEY_S:
      save_wanted_ = true;
      break;
    case GLFW_KEY_Q:
      glfwSetWindowShouldClose(window_, GLFW_TRUE);
      break;
    default:
      break;
  }
}

/// Plays or pauses the film; at its end, plays it again.
void DebugWindow::toggle_play() {
  if (state_.has_ended) link_.seek(0);
  if (!state_.has_ended || !state_.is_playing) link_.play(!state_.is_playing);
}

void DebugWindow::use_settings(size_t which) {
  for (const auto& [name, value] : settings_.use(which)) change(name, value);
}

void DebugWindow::draw_controls_and_use(const Brush& brush, const Rect& panel) {
  const ControlsActions actions = draw_controls(brush, panel, state_, settings_);
  for (const auto& [name, value] : actions.changes) change(name, value);
  if (actions.resets) {
    for (const auto& [name, value] : settings_.reset()) change(name, value);
  }
  if (actions.preset) link_.load_preset(*actions.preset);
  if (actions.settings) use_settings(*actions.settings);
}

bool DebugWindow::offers_hand() const {
  return state_.device && state_.device->has_hand;
}

/// Returns the track that is played, and what a click does, until the user has clicked once; while
/// the hand touches the picture, how deep it is.
std::string DebugWindow::hint() const {
  if (hand_.holds() && report_.touch.on) {
    return formatted("Hand %.1f mm %s. Wheel or Shift+drag: away or near",
                     std::fabs(1e3 * hand_.z_m()), hand_.z_m() > 0 ? "near" : "away");
  }
  const std::string track =
      report_.track ? "Playing " + report_.track->substr(report_.track->rfind('/') + 1) + ". " : "";
  if (has_clicked_) return track;
  const char* const choosing = "Click an object to feel it in this scene. ";
  const char* const leading = "Hold the left button in the picture to move the simulated hand.";
  return track + (offers_choice(report_) && !report_.frame.objects.empty() ? choosing : "") +
         (offers_hand() ? leading : "");
}

void DebugWindow::use_mouse(const Mouse& mouse, const Rect& picture) {
  has_clicked_ = has_clicked_ || (mouse.down && !mouse.taken && picture.has(mouse.at_px));
  if (const auto request = click_.update(mouse, picture, report_)) choose(*request);
  if (!offers_hand() || picture.width <= 0 || click_.holds()) {
    hand_.release();
    return link_.lead_hand(std::nullopt);
  }
  const GripPointer pointer(state_.device->geometry, report_.turn);
  link_.lead_hand(hand_.update(mouse, picture, pointer));
}

/// The wheel changes how many seconds the plots show.
void DebugWindow::use_plots(const Mouse& mouse, const Layout& layout) {
  const bool is_over =
      !mouse.taken && (layout.force.has(mouse.at_px) || layout.speed.has(mouse.at_px));
  if (is_over && mouse.wheel != 0) timeline_.zoom(std::pow(kZoom, -mouse.wheel));
}

SceneChoices& DebugWindow::choices() {
  return choices_[report_.film.name()];
}

void DebugWindow::follow_choices(const std::string& film_before) {
  bool has_ended = false;
  if (film_before != report_.film.name()) has_ended = choices_[film_before].end_scene();
  // Otherwise nothing would be felt until the user releases the object.
  if (choices().update(report_) || has_ended) link_.choose(std::nullopt);
  if (const std::optional<int64_t> lost_ns = choices().take_lost()) {
    constexpr int64_t kTenth_ns = 100'000'000;
    show_note("The chosen object was lost at " + time_text(*lost_ns / kTenth_ns * kTenth_ns) +
              "; what the settings say is felt again.");
  }
  save_choices(&SceneChoices::has_late_end);
}

void DebugWindow::choose(const ChoiceRequest& request) {
  link_.choose(request.position);
  requested_ = request.position ? request.object : 0;
  click_before_ = report_.click;
  const SeenObject* const object = seen_objects_.find(request.object);
  if (!request.position) {
    choices().undo_last();
  } else if (object) {
    choices().choose(*object);
  }
}

bool DebugWindow::has_unsaved_choices() const {
  for (const auto& [film, choices] : choices_) {
    if (!film.empty() && choices.has_unsaved()) return true;
  }
  return false;
}

/// Saves the choices of every film for which `is_due` holds.
void DebugWindow::save_choices(bool (SceneChoices::*is_due)() const) {
  for (auto& [film, choices] : choices_) {
    if (film.empty() || !(choices.*is_due)()) continue;
    const ChoicesSaved saved = link_.save(film, choices.edits());
    show_note(saved.what);
    saved.is_done ? choices.saved() : choices.not_saved();
  }
}

void DebugWindow::draw_choices(const Brush& brush, const Rect& panel) {
  const FilmStrip strip = film_strip(report_, state_.rules.get(), choices().edits());
  const TimelineActions actions =
      draw_timeline(brush, panel, timeline_, state_, strip, has_unsaved_choices());
  if (actions.removed) remove_choice(*actions.removed);
  if (actions.saves) save_choices(&SceneChoices::has_unsaved);
  if (actions.toggles) toggle_play();
  if (actions.seek_ns) link_.seek(*actions.seek_ns);
}

/// Removes a choice, and releases its object if that is felt now.
void DebugWindow::remove_choice(const FeelRule& rule) {
  const int64_t now_ns = report_.stamp.stream_ns;
  if (rule.from_ns <= now_ns && now_ns < rule.to_ns && report_.click != 0) {
    link_.choose(std::nullopt);
  }
  choices().remove(rule.from_ns, rule.to_ns);
}

void DebugWindow::end_choices() {
  for (auto& [film, choices] : choices_) choices.end_scene();
  save_choices(&SceneChoices::has_late_end);
}

}  // namespace spidar::window
