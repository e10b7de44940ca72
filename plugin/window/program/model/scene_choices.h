// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/choice/feel_rules.h"
#include "plugin/window/view/window_view.h"

namespace spidar::window {

/// Where a frame is in its scene.
struct ScenePlace {
  FilmScene scene;
  FrameStamp stamp;

  /// Whether the frame `next` continues the scene. In reverse playback, none does.
  bool is_continued_by(const DrawnFrame& next) const {
    return is_same_run(next) && scene.begin_ns == next.film.begin_ns && next.stamp.rate > 0;
  }
  /// Whether nothing but a cut can be between this frame and `next`.
  bool is_same_run(const DrawnFrame& next) const {
    return stamp.epoch == next.stamp.epoch && scene.name() == next.film.name();
  }
};

struct SeenObject {
  uint32_t id = 0;
  int64_t first_ns = -1;                 ///< in the film; −1: unknown
  Eigen::Vector2d first_position{0, 0};  ///< a fraction of the shown picture
  int64_t last_ns = -1;
};

/// The objects that were seen in the scene on the screen.
class SeenObjects {
 public:
  /// An object that has been invisible for longer is forgotten, because it would return as another.
  static constexpr int64_t kForgotten_ns = 2'000'000'000;

  /// Processes the next frame on the screen. In another scene or film, forgets all objects.
  void update(const DrawnFrame& report);
  /// Returns null for an unknown object.
  const SeenObject* find(uint32_t id) const;

 private:
  std::vector<SeenObject> seen_;
  ScenePlace place_;
};

/// What a person chose in the scenes of one film, as changes to the rules of what is felt. A choice
/// is a rule from the moment at which its object was first seen up to the end of the scene, which
/// is known once a cut has come. Until then, and when a seek leaves the scene earlier, the rule
/// ends with the seen part of the scene; when the object is lost, the rule ends when the object was
/// last seen. Times are whole milliseconds.
class SceneChoices {
 public:
  /// Processes the next frame on the screen. Returns true when a choice ends with its scene.
  bool update(const DrawnFrame& report);

  /// When the object of a choice was last seen, if it has been lost since the last call.
  std::optional<int64_t> take_lost() { return std::exchange(lost_ns_, std::nullopt); }

  /// Chooses `object`, in place of the choice in this scene while the object was visible. Changes
  /// nothing where the time in the film is unknown.
  void choose(const SeenObject& object);
  /// Undoes the last choice in this scene.
  void undo_last();
  /// Removes all rules from one time to another.
  void remove(int64_t from_ns, int64_t to_ns);
  /// Ends the scene. Returns true when a choice ends with it.
  bool end_scene();

  bool has_unsaved() const;
  /// Whether a choice was saved before its end was known, and the end is known now.
  bool has_late_end() const;
  std::vector<FeelEdit> edits() const;
  /// Call this when the edits have been saved; forgets complete ones.
  void saved();
  /// Call this when the edits could not be saved: the user must save again.
  void not_saved();

 private:
  struct Choice {
    FeelEdit edit;
    uint32_t object = 0;
    int64_t seen_ns = 0;        ///< when the object was last seen
    uint32_t click_before = 0;  ///< the click that the element knew when the choice was made
    bool is_kept = false;       ///< by the element, which knows the click
    bool grows = false;         ///< with the scene
    bool is_removal = false;
    bool is_saved = false;
    bool was_saved = false;  ///< with an earlier end
  };
  void follow(Choice& choice, const DrawnFrame& report);
  void undo_where(const std::function<bool(const Choice&)>& which);

  std::vector<Choice> choices_;
  ScenePlace place_;
  int64_t end_ns_ = 0;  ///< of the last frame
  uint32_t click_ = 0;  ///< of the last frame
  std::optional<int64_t> lost_ns_;
};

struct StripMark {
  FeelRule rule;
  bool is_new = false;  ///< whether the mark is not saved yet
};

struct FilmStrip {
  int64_t now_ns = 0;
  int64_t length_ns = 0;  ///< 0: there is nothing to show
  std::vector<StripMark> marks;

  /// 0 at the beginning of the film, 1 at its end, and clamped to that range.
  double fraction(int64_t ns) const;
  /// The mark at this fraction, or no further than `reach` from it; null when there is none.
  const StripMark* at(double position, double reach) const;
};

/// The strip of a film from a file with known times; else an empty strip. `rules` may be null.
FilmStrip film_strip(const DrawnFrame& report, const FeelRules* rules,
                     const std::vector<FeelEdit>& edits);

}  // namespace spidar::window
