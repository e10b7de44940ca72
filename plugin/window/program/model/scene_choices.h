// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a person chose in the scenes of one film, as changes to the rules of what is felt.
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

struct Sighting {
  uint32_t id = 0;
  int64_t first_ns = -1;                 ///< in the film; −1: not known
  Eigen::Vector2d first_position{0, 0};  ///< a fraction of the picture as it is shown
  int64_t last_ns = -1;
};

/// The objects seen in the scene that is on the screen.
class Sightings {
 public:
  /// An object that has been out of sight for longer is forgotten: were it seen again, it would be
  /// another one.
  static constexpr int64_t kForgotten_ns = 2'000'000'000;

  /// The next frame that is on the screen. Another scene or film forgets all.
  void update(const DrawnFrame& report);
  /// Null when it is not known.
  const Sighting* find(uint32_t id) const;

 private:
  std::vector<Sighting> seen_;
  ScenePlace place_;
};

/// A choice is a rule from the moment at which its object was seen first up to the end of the
/// scene, which is known once a cut has come. Until then, and where a seek leaves the scene before,
/// it ends with what was seen of the scene; where the object is lost, it ends when the object was
/// last seen. Times are whole milliseconds.
class SceneChoices {
 public:
  /// The next frame that is on the screen. True when a choice ends because its scene has ended.
  bool update(const DrawnFrame& report);

  /// When the object of a choice was last seen, if it has been lost since the last call.
  std::optional<int64_t> take_lost() { return std::exchange(lost_ns_, std::nullopt); }

  /// Chooses `object`, in place of what was chosen in this scene while it was in sight. Changes
  /// nothing where the time in the film is not known.
  void choose(const Sighting& object);
  /// Takes back the last of the choices in this scene.
  void let_go();
  /// Lets no rule hold any more from one time to another.
  void remove(int64_t from_ns, int64_t to_ns);
  /// The scene has ended. True when a choice ends with it.
  bool end_scene();

  bool has_unsaved() const;
  /// Whether a choice was saved before its end was known, and the end is known now.
  bool has_late_end() const;
  /// The choices as edits, in the order in which they were made.
  std::vector<FeelEdit> edits() const;
  /// The edits have been saved; those that are complete are forgotten.
  void saved();
  /// The edits could not be saved: the user has to ask again.
  void not_saved();

 private:
  struct Choice {
    FeelEdit edit;
    uint32_t object = 0;
    int64_t seen_ns = 0;        ///< when the object was last seen
    uint32_t click_before = 0;  ///< the one that the element knew of when the choice was made
    bool is_kept = false;       ///< by the element, which knows of the click
    bool grows = false;         ///< with the scene
    bool is_removal = false;
    bool is_saved = false;
    bool was_saved = false;  ///< with an earlier end
  };
  void follow(Choice& choice, const DrawnFrame& report);
  void take_back(const std::function<bool(const Choice&)>& which);

  std::vector<Choice> choices_;
  ScenePlace place_;
  int64_t end_ns_ = 0;  ///< of the frame that was seen last
  uint32_t click_ = 0;  ///< the same
  std::optional<int64_t> lost_ns_;
};

struct StripMark {
  FeelRule rule;
  bool is_new = false;  ///< not saved yet
};

struct FilmStrip {
  int64_t now_ns = 0;
  int64_t length_ns = 0;  ///< 0: there is nothing to show
  std::vector<StripMark> marks;

  /// 0 at the beginning of the film, 1 at its end; never beyond.
  double fraction(int64_t ns) const;
  /// The mark at this fraction, or no further than `reach` from it; null when there is none.
  const StripMark* at(double position, double reach) const;
};

/// The strip of a film from a file, if the time in it is known; else an empty one. `rules` may be
/// null.
FilmStrip film_strip(const DrawnFrame& report, const FeelRules* rules,
                     const std::vector<FeelEdit>& edits);

}  // namespace spidar::window
