// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What the user chooses of the objects in the picture.
#include "plugin/window/program/debug_window.h"

namespace spidar {

SceneChoices& DebugWindow::choices() {
  return choices_[facts_.film.name()];
}

void DebugWindow::follow_choices(const std::string& film_before) {
  bool has_ended = false;
  if (film_before != facts_.film.name()) has_ended = choices_[film_before].end_scene();
  // Without this, nothing would be felt until the object is given up.
  if (choices().see(facts_) || has_ended) link_.choose(std::nullopt);
  save_late_ends();
}

void DebugWindow::choose(const ObjectWish& wish) {
  link_.choose(wish.place);
  const Sighting* const object = sightings_.find(wish.object);
  if (!wish.place) {
    choices().let_go();
  } else if (object) {
    choices().choose(*object);
  }
}

bool DebugWindow::has_unsaved_choices() const {
  for (const auto& [film, choices] : choices_)
    if (!film.empty() && choices.has_unsaved()) return true;
  return false;
}

void DebugWindow::save_choices() {
  for (auto& [film, choices] : choices_)
    if (choices.has_unsaved()) save_choices(film, choices);
}

void DebugWindow::save_late_ends() {
  for (auto& [film, choices] : choices_)
    if (choices.has_late_end()) save_choices(film, choices);
}

void DebugWindow::save_choices(const std::string& film, SceneChoices& choices) {
  if (film.empty()) return;
  const ChoicesSaved saved = link_.save(film, choices.edits());
  say(saved.what);
  saved.is_done ? choices.saved() : choices.not_saved();
}

void DebugWindow::draw_choices(const Brush& brush, const Rect& panel) {
  const FilmStrip strip = film_strip(facts_.film, state_.rules.get(), choices().edits());
  const double max_force_N = facts_.controller.max_force_N;
  const TimelineUse use =
      draw_timeline(brush, panel, timeline_, max_force_N, strip, has_unsaved_choices());
  if (use.removed) remove_choice(*use.removed);
  if (use.saves) save_choices();
}

/// Removing the choice that is felt lets go of its object.
void DebugWindow::remove_choice(const FeelRule& rule) {
  const int64_t now_ns = facts_.film.stream_ns;
  if (rule.from_ns <= now_ns && now_ns < rule.to_ns && facts_.click != 0) {
    link_.choose(std::nullopt);
  }
  choices().remove(rule.from_ns, rule.to_ns);
}

void DebugWindow::end_choices() {
  for (auto& [film, choices] : choices_) choices.end_scene();
  save_late_ends();
}

}  // namespace spidar
