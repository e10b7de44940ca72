// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/program/model/scene_choices.h"

#include <algorithm>

#include "plugin/window/program/model/object_click.h"

namespace spidar::window {
namespace {

constexpr int64_t kMillisecond = 1'000'000;
constexpr int64_t kLongestFrame_ns = 1'000'000'000;  ///< longer than between two frames of any film

/// Rounds down to a millisecond, so that a rule from there on holds for the frame.
int64_t whole(int64_t ns) {
  return ns / kMillisecond * kMillisecond;
}

/// Rounds a position to thousandths, for people who read the rules.
Eigen::Vector2d whole(const Eigen::Vector2d& position) {
  return (position * 1000).array().round() / 1000;
}

}  // namespace

void SeenObjects::update(const DrawnFrame& report) {
  const int64_t now_ns = report.stamp.stream_ns;
  if (!place_.is_continued_by(report)) seen_.clear();
  place_ = {report.film, report.stamp};
  for (const MovingObject& object : report.frame.objects) {
    if (object.points == 0) continue;
    auto known = std::find_if(seen_.begin(), seen_.end(),
                              [&](const SeenObject& one) { return one.id == object.id; });
    if (known == seen_.end()) {
      const Eigen::Vector2d position = report.turn.displayed_position(position_of(report, object));
      known = seen_.insert(known, {object.id, now_ns, position, now_ns});
    }
    known->last_ns = now_ns;
  }
  const auto is_gone = [&](const SeenObject& one) { return one.last_ns + kForgotten_ns < now_ns; };
  seen_.erase(std::remove_if(seen_.begin(), seen_.end(), is_gone), seen_.end());
}

const SeenObject* SeenObjects::find(uint32_t id) const {
  const auto found =
      std::find_if(seen_.begin(), seen_.end(), [&](const SeenObject& one) { return one.id == id; });
  return found == seen_.end() ? nullptr : &*found;
}

bool SceneChoices::update(const DrawnFrame& report) {
  const ScenePlace before = std::exchange(place_, {report.film, report.stamp});
  const int64_t now_ns = place_.stamp.stream_ns;
  if (now_ns < 0) return false;
  bool has_ended = false;
  if (!before.is_continued_by(report)) {
    if (before.is_same_run(report) && place_.stamp.rate > 0) end_ns_ = report.film.begin_ns;
    has_ended = end_scene();
  }
  end_ns_ = now_ns + std::clamp<int64_t>(report.frame.interval_ns, 0, kLongestFrame_ns);
  click_ = report.click;
  for (Choice& choice : choices_) follow(choice, report);
  return has_ended;
}

void SceneChoices::follow(Choice& choice, const DrawnFrame& report) {
  if (!choice.grows) return;
  const bool is_kept = click_ != 0 && click_ != choice.click_before;
  const std::vector<MovingObject>& objects = report.frame.objects;
  const bool is_seen = (is_kept && report.frame.felt_object != 0) ||
                       std::any_of(objects.begin(), objects.end(), [&](const MovingObject& object) {
                         return object.id == choice.object && object.points > 0;
                       });
  if (is_seen) choice.seen_ns = end_ns_;
  const bool is_lost = choice.is_kept && !is_kept;
  choice.is_kept = is_kept;
  choice.edit.to_ns = whole(is_lost ? choice.seen_ns : end_ns_);
  if (!is_lost) return;
  choice.grows = choice.is_saved = false;
  lost_ns_ = choice.seen_ns;
}

bool SceneChoices::end_scene() {
  bool has_ended = false;
  for (Choice& choice : choices_) {
    if (!choice.grows) continue;
    choice.grows = choice.is_saved = false;
    choice.edit.to_ns = whole(end_ns_);
    has_ended = true;
  }
  return has_ended;
}

/// Takes choices back. A saved one remains as an edit that removes its rule from the file.
void SceneChoices::undo_where(const std::function<bool(const Choice&)>& which) {
  for (Choice& choice : choices_) {
    if (!choice.grows || !which(choice)) continue;
    choice.grows = choice.is_saved = false;
    choice.edit.position.reset();
  }
  const auto is_nothing = [](const Choice& choice) {
    return !choice.edit.position && !choice.is_removal && !choice.was_saved;
  };
  choices_.erase(std::remove_if(choices_.begin(), choices_.end(), is_nothing), choices_.end());
}

void SceneChoices::choose(const SeenObject& object) {
  if (place_.stamp.stream_ns < 0 || object.first_ns < 0) return;
  const int64_t from_ns = whole(object.first_ns);
  undo_where([&](const Choice& other) { return other.seen_ns > object.first_ns; });
  for (Choice& other : choices_) {
    if (!other.grows) continue;  // otherwise the object came after this one had gone
    other.grows = other.is_saved = false;
    other.edit.to_ns = from_ns;
  }
  Choice choice;
  choice.edit = {from_ns, whole(end_ns_), whole(object.first_position)};
  choice.object = object.id;
  choice.click_before = click_;
  choice.seen_ns = end_ns_;
  choice.grows = true;
  choices_.push_back(choice);
}

void SceneChoices::undo_last() {
  undo_where([](const Choice&) { return true; });
}

void SceneChoices::remove(int64_t from_ns, int64_t to_ns) {
  undo_where([&](const Choice& choice) {
    return choice.edit.from_ns < to_ns && choice.edit.to_ns > from_ns;
  });
  Choice choice;
  choice.edit = {from_ns, to_ns, std::nullopt};
  choice.is_removal = true;
  choices_.push_back(choice);
}

bool SceneChoices::has_unsaved() const {
  return std::any_of(choices_.begin(), choices_.end(),
                     [](const Choice& choice) { return !choice.is_saved; });
}

bool SceneChoices::has_late_end() const {
  return std::any_of(choices_.begin(), choices_.end(), [](const Choice& choice) {
    return choice.was_saved && !choice.is_saved && choice.edit.position;
  });
}

std::vector<FeelEdit> SceneChoices::edits() const {
  std::vector<FeelEdit> edits;
  for (const Choice& choice : choices_) edits.push_back(choice.edit);
  return edits;
}

void SceneChoices::saved() {
  const auto is_complete = [](const Choice& choice) { return !choice.grows; };
  choices_.erase(std::remove_if(choices_.begin(), choices_.end(), is_complete), choices_.end());
  for (Choice& choice : choices_) choice.is_saved = choice.was_saved = true;
}

void SceneChoices::not_saved() {
  for (Choice& choice : choices_) choice.is_saved = choice.was_saved = false;
}

double FilmStrip::fraction(int64_t ns) const {
  if (length_ns <= 0) return 0;
  return std::clamp(static_cast<double>(ns) / static_cast<double>(length_ns), 0.0, 1.0);
}

const StripMark* FilmStrip::at(double position, double reach) const {
  const StripMark* best = nullptr;
  double nearest = reach;
  for (const StripMark& mark : marks) {
    const double before = fraction(mark.rule.from_ns) - position,
                 behind = position - fraction(mark.rule.to_ns);
    const double distance = std::max({before, behind, 0.0});
    if (distance > nearest || (best && distance == nearest)) continue;
    best = &mark;
    nearest = distance;
  }
  return best;
}

FilmStrip film_strip(const DrawnFrame& report, const FeelRules* rules,
                     const std::vector<FeelEdit>& edits) {
  FilmStrip strip;
  const int64_t now_ns = report.stamp.stream_ns;
  if (report.film.name().empty() || now_ns < 0) return strip;
  const std::vector<FeelRule> before = rules ? rules->rules() : std::vector<FeelRule>();
  std::vector<FeelRule> now = before;
  for (const FeelEdit& edit : edits) now = edited(now, edit);
  strip.now_ns = now_ns;
  strip.length_ns = std::max(report.film.length_ns, now_ns);
  for (const FeelRule& rule : now) {
    if (rule.to_ns != FeelRule::kNoEnd) strip.length_ns = std::max(strip.length_ns, rule.to_ns);
    // A saved choice grows with its scene.
    const auto is_same = [&](const FeelRule& other) {
      return other.from_ns == rule.from_ns && other.kind == rule.kind &&
             other.position == rule.position;
    };
    strip.marks.push_back({rule, std::none_of(before.begin(), before.end(), is_same)});
  }
  return strip;
}

}  // namespace spidar::window
