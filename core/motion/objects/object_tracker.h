// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Follows objects that move relative to the background from frame to frame.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/field/block_field.h"
#include "core/field/fine_windows.h"
#include "core/motion/camera/background.h"
#include "core/motion/camera/block_votes.h"
#include "core/motion/camera/motion_models.h"
#include "core/motion/layers/moving_blocks.h"
#include "core/motion/layers/parallax.h"
#include "core/motion/layers/regions.h"
#include "core/motion/layers/salience.h"
#include "core/motion/objects/error_bound.h"
#include "core/motion/objects/moving_object.h"
#include "core/motion/objects/object_life.h"
#include "core/motion/objects/object_motion.h"
#include "core/motion/objects/turn_meter.h"

namespace spidar {

/// The field of block motion of one frame, and how its pixels map to the frame.
struct FieldInFrame {
  const BlockField& field;
  double scale = 1;  ///< frame pixels to one pixel of the field's picture
  /// Centre of the field relative to the centre of the frame, px of the frame.
  Eigen::Vector2d offset_px = Eigen::Vector2d::Zero();
  double interval_s = 0;  ///< since the previous frame, > 0
  const std::vector<FineMotion>& fine;
};

/// Follows objects from frame to frame. A region that moves by itself becomes an object in the
/// second frame in which its motion is similar. A region belongs to the object to which most of its
/// blocks belonged before, or else to an object out of sight that is expected there, so that an
/// object that passes behind another one keeps its id. While the motion of the background is
/// unknown, all objects are out of sight. An object is dropped when it has been out of sight or at
/// rest for kForgotten_s.
class ObjectTracker {
 public:
  ObjectTracker();

  /// The result is valid until the next call and ordered by id. Ids count the objects that were in
  /// a result, so that their number identifies the next one. `background` is in pixels of the
  /// field's picture.
  const std::vector<MovingObject>& update(const FieldInFrame& frame, const Background& background);

  /// What the next frame's votes on the camera depend on.
  Past past() const {
    const BurnedIn& burned_in = moving_.burned_in();
    return {moving_.persistence(), burned_in.held(), owners_, burned_in.margins().columns(),
            burned_in.margins().rows()};
  }
  /// A number of the object to which each block belongs in the last frame; 0 for none.
  const std::vector<uint32_t>& owners() const { return owners_; }

  /// Whether a block moved by itself in the last frame.
  bool moves(size_t block) const { return (*relative_)[block].moves; }
  /// Whether a block was used to measure the motion of an object in the last frame.
  bool is_measured(size_t block) const {
    return block < owners_.size() && owners_[block] != 0 && (*relative_)[block].shows_motion;
  }

  /// Forgets everything, after a cut or a seek.
  void reset();

  static constexpr double kForgotten_s = ObjectLife::kForgotten_s;
  static constexpr size_t kMostObjects = 16;

 private:
  using Life = ObjectLife;
  using State = ObjectLife::State;

  /// Blocks on which an object was before, and which now do not clearly move by themselves.
  struct Remains {
    int blocks = 0;
    int found = 0;  ///< those of them that are found in the picture before, and are not plain
  };

  void claim(const FieldInFrame& frame);
  Life* owner_of(int16_t region);
  Life* expected_at(const Region& region, const FieldInFrame& frame);
  static bool remains_there(const Life& life, const Remains& remains);
  bool is_enough(const Region& region, const Life* life, const BlockField& field) const;
  uint32_t create(const Region& region);
  bool has_vanished(const Life& life, const FieldInFrame& frame) const;
  void observe(Life& life, const FieldInFrame& frame);
  Remains remains_of(const Life& life, const BlockField& field) const;
  void stay(Life& life, const FieldInFrame& frame);
  void miss(Life& life, const FieldInFrame& frame);
  ObjectEvidence evidence_in(const FieldInFrame& frame) const {
    return {frame.field, *relative_, owners_, frame.fine, *background_};
  }
  ObjectMotion measure(Life& life, const FieldInFrame& frame);
  void turn(Life& life, const ObjectMotion& found, const FieldInFrame& frame);
  void position(Life& life, const FieldInFrame& frame) const;
  double noise_around(const Life& life);

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
  std::vector<Life> lives_;
  std::vector<MovingObject> objects_;
  uint32_t next_key_ = 1;
  uint32_t next_id_ = 1;
};

}  // namespace spidar
