// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/choice/feel_rules.h"
#include "core/motion/camera/background.h"
#include "core/motion/objects/moving_object.h"
#include "core/orientation.h"
#include "core/picture/film_area.h"

namespace spidar {

/// A box that a detector or a tracker outside this project found in a picture. Corners go from (0,
/// 0), the top left corner of the shown picture, to (1, 1); a box may lie partly outside.
struct PictureBox {
  std::string name;                ///< of its content: "face"
  Eigen::Vector2d position{0, 0};  ///< the corner that is nearer to (0, 0)
  Eigen::Vector2d far_corner{1, 1};
};

/// An object that is kept because it was clicked.
struct KeptObject {
  uint32_t click = 0;              ///< number of the click; 0: none is kept
  Eigen::Vector2d position{0, 0};  ///< of the click
};

struct Chosen {
  /// Whether the object of a rule or a click could be found.
  enum class State {
    kGood,
    kNotThere,   ///< no object was at the position; the first that begins to move there is felt
    kNotSeen,    ///< playback began after the moment at which the object is at the position
    kLost,       ///< the object was followed and is lost
    kNoBox,      ///< no frame of the rule had a box of that name
    kBoxAtRest,  ///< there were boxes, but nothing moves in them
  };

  std::optional<FeelRule> rule;  ///< the rule that holds now; none: none does
  bool is_kept = false;          ///< a click decides, not a rule
  State state = State::kGood;
  const MovingObject* object = nullptr;  ///< the felt object; null if there is no single one

  /// Whether neither a rule nor a click decides: the setting `motion` decides what is felt.
  bool is_free() const { return !rule && !is_kept; }
};

/// The part of a frame that a choice needs. Rules and clicks have positions in the shown picture.
struct ChoiceInput {
  const std::vector<MovingObject>& objects;
  const Background* background;  ///< null when unknown
  const FilmPlace& place;
  /// The height of the shown film, px.
  int height() const { return turn.is_sideways() ? place.area.width : place.area.height; }
  double interval_s;  ///< since the previous frame; 0 when there is none
  bool is_cut;        ///< the frame shows nothing of the previous one
  int64_t stream_ns;  ///< position in the film
  Orientation turn;   ///< of the frame before it is shown
  const std::vector<PictureBox>* boxes = nullptr;  ///< of the frame; null: none

  /// Converts a position in the shown picture to px from the middle of the film.
  Eigen::Vector2d px(const Eigen::Vector2d& position) const {
    return place.film_px(turn.stored_position(position));
  }
  Eigen::AlignedBox2d px(const Eigen::Vector2d& corner, const Eigen::Vector2d& far_corner) const {
    return Eigen::AlignedBox2d(px(corner)).extend(px(far_corner));
  }
};

/// Finds the object in a box: the box shows which object is meant, and ObjectTracker measures how
/// the object moves. A detector misses objects in some frames, so the object is kept for a moment
/// without a box. Of several objects in boxes, the largest is chosen, and remains chosen as long as
/// there is a box around it.
class BoxedObject {
 public:
  /// Uses the boxes of this name; empty: any box. `name` must stay valid until the next begin().
  void begin(const char* name);

  /// Adds the next frame. Returns the object as it is in `frame`; null when none is known.
  const MovingObject* update(const ChoiceInput& frame);

  /// Call this after a cut, when all objects have new ids.
  void cut() { id_ = 0; }

  /// kNoBox or kBoxAtRest if no box was around an object for kBoxTimeout_s after begin(); else
  /// kGood.
  Chosen::State state() const;

  /// How long an object is kept without a box: a detector that examines every tenth frame of 25 a
  /// second, as on slow machines, may miss it once.
  static constexpr double kHold_s = 0.8;
  /// How long a new rule may lack a box before this is reported.
  static constexpr double kBoxTimeout_s = 1;
  /// A box is around an object when at least this fraction of the smaller of the two lies in the
  /// other: a face is a part of a person who moves, and a moving leg a part of the person in the
  /// box.
  static constexpr double kOverlap = 0.5;

 private:
  const MovingObject* at_box(const PictureBox& box, const ChoiceInput& frame) const;

  const char* name_ = "";
  uint32_t id_ = 0;  ///< of the object; 0: none
  double missing_s_ = 0;
  double waited_s_ = 0;  ///< since begin(), until the first one was found
  bool has_found_ = false;
  bool has_box_ = false;
};

/// Finds the object that is at a position, and follows its id. ObjectTracker drops an object that
/// has rested for a while. If there is no object at the position, or the followed one came to rest
/// there, the first object that begins to move there is followed. At an apparent cut, ObjectTracker
/// gives new ids; an object that soon moves in the same way at the expected place counts as the
/// followed one.
class FollowedObject {
 public:
  enum class State {
    kSearching,  ///< searches for the object at the position
    kWaiting,    ///< no object is at the position: waits for the first motion there
    kFollowed,   ///< visible, or hidden for a moment
    kResting,    ///< at rest where it was last seen
    kLost,       ///< its position is unknown
  };

  /// Starts the search for the object that was at `position_px`, relative to the middle of the
  /// frame, `since_s` before the frame of the next update().
  void begin(const Eigen::Vector2d& position_px, double since_s);

  /// Adds the next frame. Returns the object as it is in `objects`; null when it is not among
  /// them. `interval_s` is the time since the previous frame, and `background` the motion of the
  /// background in it.
  const MovingObject* update(const std::vector<MovingObject>& objects, int frame_height,
                             double interval_s, const Background* background);

  /// Call this after a cut, when all objects have new ids.
  void cut() {
    if (id_ != 0 && (rested_ || hidden_)) state_ = State::kLost;
  }

  State state() const { return state_; }

  /// How long the search lasts: an object is known only from the second frame of its motion on.
  static constexpr double kSearch_s = 0.5;
  /// An object that is unseen for longer is lost. ObjectTracker keeps a hidden one for 0.5 s.
  static constexpr double kLost_s = 1;
  /// How far a position may be from an object's box, as a fraction of the frame's height.
  static constexpr double kReach = 0.05;

 private:
  const MovingObject* at_position(const std::vector<MovingObject>& objects, double reach_px) const;
  bool may_be(const MovingObject& object) const;
  void follow(const MovingObject& object);
  void miss(double interval_s);

  State state_ = State::kLost;
  bool is_first_ = true;  ///< the next update() is the first
  uint32_t id_ = 0;
  Eigen::Vector2d position_px_ = Eigen::Vector2d::Zero();    ///< actual or predicted
  Eigen::Vector2d velocity_px_s_ = Eigen::Vector2d::Zero();  ///< relative to the background
  double since_s_ = 0;                                       ///< since begin()
  double missing_s_ = 0;
  bool rested_ = false;                ///< when last seen
  bool hidden_ = false;                ///< when last known
  std::array<uint32_t, 32> before_{};  ///< ids in the previous frame
  size_t before_count_ = 0;
};

/// Chooses what is felt of a frame: by rules, by boxes from outside, or by a click. Call choose()
/// for the frames in the order of display. Allocates nothing.
class ObjectChoice {
 public:
  /// If the rule of the last frame is also one of the new rules, it keeps its object.
  void set_rules(std::shared_ptr<const FeelRules> rules);
  void set_kept(const KeptObject& kept);

  /// The result points into `frame`.
  Chosen choose(const ChoiceInput& frame);

  /// Call this after a seek: all objects are new.
  void reset();

  /// How much another object must surpass the one that is felt: 1.3 times its size, or a twentieth
  /// of the frame's height further in the direction of the rule.
  static constexpr double kLarger = 1.3;
  static constexpr double kFurther = 0.05;
  /// How long the object that is felt may be invisible before it is given up.
  static constexpr double kHold_s = 0.2;

 private:
  void begin(const FeelRule& rule, const ChoiceInput& frame);
  void by_position(const ChoiceInput& frame, Chosen& choice);
  void by_rule(const FeelRule& rule, const ChoiceInput& frame, Chosen& choice);
  const MovingObject* best(const FeelRule& rule, const ChoiceInput& frame);
  bool follow_click(const ChoiceInput& frame, Chosen& choice);

  std::shared_ptr<const FeelRules> rules_;
  const FeelRule* rule_ = nullptr;  ///< of the previous frame
  bool seen_from_begin_ = false;    ///< of the rule, see Chosen::State::kNotSeen
  FollowedObject ruled_;
  bool missed_ = false;  ///< `ruled_` found nothing at its position
  BoxedObject boxed_;
  uint32_t best_ = 0;  ///< id of the object of kLargest or kFurthest; 0: none
  double best_missing_s_ = 0;

  KeptObject kept_;
  uint32_t followed_click_ = 0;
  FollowedObject clicked_;
};

}  // namespace spidar
