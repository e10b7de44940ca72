// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_field.h"
#include "core/field/fine_windows.h"
#include "core/motion/camera/background.h"
#include "core/motion/camera/block_votes.h"
#include "core/motion/camera/motion_models.h"
#include "core/motion/layers/moving_blocks.h"
#include "core/motion/layers/regions.h"
#include "core/motion/objects/moving_object.h"
#include "core/motion/objects/object_motion.h"
#include "core/motion/objects/turn_meter.h"

namespace spidar {

/// The state of an object that is followed from frame to frame.
struct Track {
  enum class State : uint8_t {
    kSeen,    ///< a region of this frame shows it
    kRests,   ///< most of the object is where it was, and nothing there clearly moves
    kHidden,  ///< nothing shows it
  };

  /// Position, motion and size in the last frame in which most of an object was visible. A rim does
  /// not determine any of these.
  struct Expected {
    double blocks = 0;  ///< when nothing hides it
    Eigen::Vector2d position_px = Eigen::Vector2d::Zero();
    Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();
    Eigen::Vector2d sides_px = Eigen::Vector2d::Zero();
  };

  /// An object is confirmed when it has been seen with this many blocks in all its frames together,
  /// so a small object must be seen more often. A single frame never suffices, because noise does
  /// not move twice in the same way.
  static constexpr int kConfirmBlocks = 7;
  /// With a smaller fraction of its usual blocks, only a rim of an object is visible.
  static constexpr double kRimFraction = 0.5;
  /// How long an object may be invisible or at rest before it is dropped: longer than objects are
  /// usually hidden, and than most pauses in their motion.
  static constexpr double kForgotten_s = 0.5;
  /// Time constant with which the drawn box follows the blocks. At 25 frames/s, a block that
  /// appears in every second frame moves the box by a tenth of the block.
  static constexpr double kBoxSettles_s = 0.4;

  uint32_t key = 0;     ///< in the order of creation, > 0
  MovingObject object;  ///< its id is 0 until it has been in a result
  Region region;        ///< in the last frame in which it was seen
  Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();  ///< in the field, smoothed
  Expected expected;
  SteadyRate roll, growth;
  /// Corners of the drawn box, in the field.
  Eigen::Vector2d low_px = Eigen::Vector2d::Zero(), high_px = Eigen::Vector2d::Zero();
  State state = State::kSeen;
  double since_s = 0;  ///< how long the object has been at rest or hidden
  LayerEvidence evidence;
  int blocks_seen = 0;     ///< in all frames together, see kConfirmBlocks
  bool is_proven = false;  ///< was clearly no layer of the scene in one of its frames
  bool is_layer = false;   ///< looks more like a part of the scene than like an object

  bool is_seen() const { return state == State::kSeen; }
  bool is_confirmed() const { return blocks_seen >= kConfirmBlocks; }
  void set_state(State next) {
    if (state != next) since_s = 0;
    state = next;
  }

  /// Whether the region moves as the object did: like alike_px(), but with kMaxOff_px, the largest
  /// error of a block's motion, in place of its noise.
  bool moves_like(const Region& other, double interval_s) const {
    const Eigen::Vector2d expected_px = velocity_px_s * interval_s;
    const double fastest_px = std::max(expected_px.norm(), other.relative_px.norm());
    return (other.relative_px - expected_px).norm() <
           kAlikeFraction * fastest_px + static_cast<double>(kMaxOff_px);
  }
  /// Whether the region may be the object after a bounce. In the picture with the impact, and often
  /// in the next, the object moves unlike before and is invisible. Afterwards the object is no
  /// faster than before, and no further away than it can have moved. The motion of errors and of
  /// layers changes in this way, too, so the object must be no layer, and must have been seen for
  /// kKnown times as long as its confirmation took: the probability that errors move alike for so
  /// long is the kKnown-th power of the probability that they are confirmed.
  bool has_bounced_to(const Region& other, double interval_s) const {
    constexpr int kKnown = 4;
    if (!is_proven || is_layer || blocks_seen < kKnown * kConfirmBlocks) return false;
    constexpr double kMaxPictures = 2;  // that with the impact, and the next
    constexpr double kMaxError_px = kMaxOff_px;
    const double speed_px_s = expected.velocity_px_s.norm();
    if (since_s > (kMaxPictures + 0.5) * interval_s || speed_px_s * interval_s < kMaxError_px) {
      return false;
    }
    const Eigen::Vector2d seen_at_px = expected.position_px - since_s * expected.velocity_px_s;
    return other.relative_px.norm() < speed_px_s * interval_s + kMaxError_px &&
           (other.position_px - seen_at_px).norm() <
               speed_px_s * (since_s + interval_s) + kBlock_px;
  }
  bool is_rim(const Region& visible) const {
    return visible.blocks < kRimFraction * expected.blocks;
  }
  /// Whether the object has just moved out of the picture, and was visible until now.
  bool has_left(double interval_s) const {
    const Eigen::Vector2d on_screen_px = expected.velocity_px_s * interval_s + region.background_px;
    return region.border_blocks > 0 && region.position_px.dot(on_screen_px) > 0;
  }
  /// Moves the drawn box as the object moves.
  void move_box(double interval_s) {
    const Eigen::Vector2d moved_px = velocity_px_s * interval_s + region.background_px;
    low_px += moved_px;
    high_px += moved_px;
  }
  /// Moves the drawn box towards the box around the blocks. The two never differ by more than a
  /// block, the precision with which blocks locate an edge.
  void draw_box_to(const Region& seen, double interval_s) {
    const double newest = interval_s / (kBoxSettles_s + interval_s);
    const auto draw = [newest](Eigen::Vector2d& corner_px, const Eigen::Vector2d& seen_px) {
      constexpr double kBlock = kBlock_px;
      corner_px += newest * (seen_px - corner_px);
      corner_px = corner_px.cwiseMax((seen_px.array() - kBlock).matrix())
                      .cwiseMin((seen_px.array() + kBlock).matrix());
    };
    draw(low_px, seen.low_px);
    draw(high_px, seen.high_px);
  }
  /// For a frame in which nothing shows how the object rotates and grows.
  void miss_rotation(double interval_s) {
    roll.miss(interval_s);
    growth.miss(interval_s);
    object.roll_rad_s = object.growth_1_s = 0;
  }
  /// Advances the expected position.
  void extrapolate(double interval_s) {
    expected.position_px += expected.velocity_px_s * interval_s + region.background_px;
  }
  /// Stores what to expect while the object is invisible. The expected number of blocks rises at
  /// once and falls slowly.
  void expect(double interval_s) {
    const double blocks = region.blocks;
    const double forgotten = std::min(1.0, interval_s / kForgotten_s);
    expected.blocks = std::max(blocks, expected.blocks + forgotten * (blocks - expected.blocks));
    if (is_rim(region)) {  // the rest of it is hidden
      extrapolate(interval_s);
      return;
    }
    expected.position_px = region.position_px;
    expected.velocity_px_s = velocity_px_s;
    expected.sides_px = region.high_px - region.low_px;
  }
};

/// The field of block motion of one frame, and how its pixels map to the frame.
struct FieldInFrame {
  const BlockField& field;
  double scale = 1;  ///< px of the frame per px of the field's picture
  /// Centre of the field relative to the centre of the frame, px of the frame.
  Eigen::Vector2d offset_px = Eigen::Vector2d::Zero();
  double interval_s = 0;  ///< since the previous frame, > 0
  const std::vector<FineMotion>& fine;
};

/// Follows objects that move relative to the background from frame to frame. A region that moves by
/// itself becomes an object in the second frame in which its motion is similar. A region belongs to
/// the object to which most of its blocks belonged before, or else to an invisible object that is
/// expected there, so that an object that passes behind another one keeps its id. While the motion
/// of the background is unknown, all objects are invisible. An object is dropped when it has been
/// invisible or at rest for kForgotten_s.
class ObjectTracker {
 public:
  /// `next_id`: trackers that share it never give two objects the same id.
  explicit ObjectTracker(std::shared_ptr<uint32_t> next_id = std::make_shared<uint32_t>(1));

  /// The result is valid until the next call and ordered by id. Ids number the objects in the order
  /// in which they first were in a result. `background` is in pixels of the field's picture.
  ///
  /// In each frame, rotation and growth are measured for the object with the id `felt` (0: none)
  /// and for one of the others, in turn; the rest keep their values. This bounds the time for a
  /// frame.
  const std::vector<MovingObject>& update(const FieldInFrame& frame, const Background& background,
                                          uint32_t felt = 0);

  /// The evidence for the next frame's votes on the camera.
  PreviousFrame past() const {
    const BurnedIn& burned_in = moving_.burned_in();
    return {moving_.foreground(), burned_in.held(), owners_, burned_in.margins().columns(),
            burned_in.margins().rows()};
  }
  /// The key of the object to which each block belongs in the last frame; 0: none.
  const std::vector<uint32_t>& owners() const { return owners_; }

  bool moves(size_t block) const { return (*relative_)[block].moves; }
  /// Whether a block was used to measure the motion of an object in the last frame.
  bool is_measured(size_t block) const {
    return block < owners_.size() && owners_[block] != 0 && (*relative_)[block].shows_motion;
  }

  /// Call this after a cut or a seek.
  void reset();

  static constexpr double kForgotten_s = Track::kForgotten_s;
  static constexpr size_t kMaxObjects = 16;

 private:
  void assign_regions(const FieldInFrame& frame);
  Track* owner_of(int16_t region);
  Track* expected_at(const Region& region, const FieldInFrame& frame);
  bool is_enough(const Region& region, const Track* track, const BlockField& field) const;
  uint32_t create(const Region& region);
  bool has_vanished(const Track& track, const FieldInFrame& frame) const;
  void observe(Track& track, const FieldInFrame& frame);
  std::optional<int> resting_blocks(const Track& track, const BlockField& field) const;
  void observe_rest(Track& track, const FieldInFrame& frame);
  void miss(Track& track, const FieldInFrame& frame);
  ObjectEvidence evidence_in(const FieldInFrame& frame) const {
    return {frame.field, *relative_, owners_, frame.fine, *background_};
  }
  ObjectMotion measure(Track& track, const FieldInFrame& frame);
  void choose_turned(uint32_t felt);
  void update_rotation(Track& track, const ObjectMotion& found, const FieldInFrame& frame);
  void position(Track& track, const FieldInFrame& frame) const;
  double noise_around(const Track& track);

  MovingBlocks moving_;
  RegionFinder finder_;
  ObjectMeter meter_;
  ErrorBound bound_;
  TurnMeter turns_;
  const std::vector<RelativeBlock>* relative_ = nullptr;
  bool camera_moves_ = false;
  const Background* background_ = nullptr;
  std::vector<uint8_t> expected_;
  std::vector<uint32_t> owners_;
  std::vector<uint32_t> owners_before_;     ///< moved to their positions in this frame
  std::vector<uint32_t> region_keys_;       ///< object of each region
  std::vector<size_t> order_;               ///< regions, largest first
  std::vector<Eigen::Vector2f> around_px_;  ///< motion of blocks around an object
  Parallax parallax_;
  std::vector<Track> tracks_;
  std::vector<MovingObject> objects_;
  uint32_t felt_key_ = 0, turned_key_ = 0;  ///< objects whose rotation is measured; 0: none
  uint32_t next_key_ = 1;
  std::shared_ptr<uint32_t> next_id_;
};

}  // namespace spidar
