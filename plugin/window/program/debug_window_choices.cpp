// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The objects of a debug window, and what the user chooses of them.
#include "plugin/window/program/debug_window.h"

namespace spidar {
namespace {

constexpr int kObjectWidth_px = 64;

/// From pixels of the visible part to shares of the frame.
Rect in_frame(const Rect& box, const VisiblePart& visible, int width, int height) {
  return {(visible.x + box.x) / width, (visible.y + box.y) / height, box.width / width,
          box.height / height};
}

}  // namespace

/// Of the frame that has just been loaded.
void DebugWindow::list_objects() {
  objects_.see(facts_);
  for (const ListedObject* object : objects_.without_picture()) {
    const Rect part =
        in_frame(object->box, facts_.visible, texture_->frame_width(), texture_->frame_height());
    Still still;
    if (!texture_->cut_to(still, part, kObjectWidth_px)) continue;
    (*object_textures_)[object->slot].load(still);
    objects_.pictured(object->id);
  }
}

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

bool DebugWindow::is_chosen(const ListedObject& object) const {
  return facts_.click != 0 && object.is_felt;
}

std::vector<ObjectRow> DebugWindow::object_list() const {
  std::vector<ObjectRow> rows;
  for (const ListedObject* object : objects_.rows()) {
    const PictureTexture& texture = (*object_textures_)[object->slot];
    ObjectRow row;
    row.object = object;
    row.is_chosen = is_chosen(*object);
    row.aspect = texture.aspect();
    if (object->pictured_px2 > 0) row.picture = (ImTextureID)uintptr_t{texture.id()};
    rows.push_back(row);
  }
  return rows;
}

/// A click on a row is one on its object in the picture.
void DebugWindow::use_objects(const Mouse& mouse, const Rect& panel) {
  const bool begins = mouse.down && !objects_down_ && !mouse.taken;
  objects_down_ = mouse.down;
  if (!begins || timeline_.is_paused() || !offers_choice(facts_)) return;
  const std::vector<const ListedObject*> rows = objects_.rows();
  const std::vector<Rect> places = object_rows(panel, scale_, rows.size());
  for (size_t i = 0; i < places.size(); ++i) {
    if (!places[i].has(mouse.at_px) || !rows[i]->is_in_sight) continue;
    ObjectWish wish;
    wish.object = rows[i]->id;
    if (!is_chosen(*rows[i])) wish.place = rows[i]->place;
    return choose(wish);
  }
}

void DebugWindow::choose(const ObjectWish& wish) {
  link_.choose(wish.place);
  const ListedObject* const object = objects_.find(wish.object);
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

void DebugWindow::draw_choices(const Brush& brush, const WindowLayout& layout, const Mouse& mouse) {
  draw_objects(brush, layout.objects, object_list(), facts_, mouse.at_px);
  if (has_unsaved_choices() && draw_save_button(brush, layout.objects)) save_choices();
  const FilmStrip strip = film_strip(facts_.film, state_.rules.get(), choices().edits());
  const double max_force_N = facts_.controller.max_force_N;
  if (const auto removed = draw_timeline(brush, layout.timeline, timeline_, max_force_N, strip)) {
    remove_choice(*removed);
  }
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
