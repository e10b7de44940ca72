// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Follows what moves beyond the background from frame to frame.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/api.h"
#include "core/field/block_field.h"
#include "core/motion/background.h"
#include "core/motion/motion_models.h"
#include "core/motion/moving_blocks.h"
#include "core/motion/moving_object.h"
#include "core/motion/object_motion.h"
#include "core/motion/regions.h"
#include "core/motion/salience.h"

namespace spidar {

/// Field of block motion of one frame, and how its pixels lie in the frame.
struct FieldInFrame {
  const BlockField& field;
  double scale = 1;  ///< frame px to one of the field's picture
  /// Of the field's centre from the frame's, px of the frame.
  Eigen::Vector2d offset_px = Eigen::Vector2d::Zero();
  double interval_s = 0;  ///< since the frame before, > 0
  const std::vector<PlacedPoint>& points;
};

/// Objects from frame to frame. A region that moves by itself is an object from the second frame on
/// in which it does so alike. It is the object that most of its blocks were before, or else the one
/// out of sight that is expected there: an object that goes behind another one, or behind something
/// that stands in front of it, comes back with its id. It dies when it is out of sight for
/// kForgotten_s or at rest for kAtRest_s; until then it may stand still.
class SPIDAR_API ObjectTracker {
 public:
  ObjectTracker();

  /// Valid until the next call; in the order of birth. `background` in pixels of the field's
  /// picture.
  const std::vector<MovingObject>& update(const FieldInFrame& frame, const Background& background);

  /// How likely each block belongs to no background, see MovingBlocks::persistence().
  const std::vector<float>& persistence() const { return moving_.persistence(); }
  /// Whether a block shows what belongs to the screen, see BurnedIn.
  bool is_burned_in(size_t block) const { return moving_.burned_in().holds(block); }
  /// The object that each block is of in the last frame, its id; 0 for none.
  const std::vector<uint32_t>& owners() const { return owners_; }

  /// Whether a block moved by itself in the last frame.
  bool moves(size_t block) const { return (*relative_)[block].moves; }
  /// Whether a block has told in the last frame how an object moves.
  bool is_measured(size_t block) const {
    return block < owners_.size() && owners_[block] != 0 && (*relative_)[block].has_texture;
  }

  /// A cut, a seek: nothing is known.
  void reset();

  static constexpr double kForgotten_s = 0.5;
  static constexpr double kAtRest_s = 1.0;
  static constexpr size_t kMostObjects = 16;

 private:
  struct Life {
    MovingObject object;
    Region region;  ///< of the last frame in which it was seen
    Eigen::Vector2d velocity_px_s = Eigen::Vector2d::Zero();  ///< of the field, smoothed
    double usual_blocks = 0;                                  ///< that show when nothing hides it
    /// Where it is, how it goes and how large it is by the last frame in which most of it showed:
    /// what shows of an object that goes out of sight is a rim that tells none of it.
    Eigen::Vector2d expected_px = Eigen::Vector2d::Zero();
    Eigen::Vector2d expected_px_s = Eigen::Vector2d::Zero();
    Eigen::Vector2d expected_sides_px = Eigen::Vector2d::Zero();
    int frames_seen = 0;
    int blocks_seen = 0;  ///< in all those frames
    int proven = 0;
    double unseen_s = 0;
    double resting_s = 0;
    bool claimed = false;   ///< by a region of this frame
    bool is_rigid = false;  ///< its points agree
    bool is_layer = false;  ///< rather a part of the scene than an object in it

    bool is_born() const;
  };

  void claim(const FieldInFrame& frame);
  Life* owner_of(int16_t region);
  Life* expected_at(const Region& region, const FieldInFrame& frame);
  bool is_same_motion(const Life& life, const Region& region, const FieldInFrame& frame) const;
  uint32_t create(const Region& region);
  void observe(Life& life, const FieldInFrame& frame);
  int count_resting(const Life& life, int& textured) const;
  void miss(Life& life, const FieldInFrame& frame);
  void expect(Life& life, const FieldInFrame& frame) const;
  void go_on_unseen(Life& life, const FieldInFrame& frame) const;
  void measure(Life& life, const FieldInFrame& frame);
  void place(Life& life, const FieldInFrame& frame) const;

  MovingBlocks moving_;
  RegionFinder finder_;
  ObjectMeter meter_;
  const std::vector<RelativeBlock>* relative_ = nullptr;
  CameraMotion camera_;
  const Background* background_ = nullptr;
  std::vector<uint8_t> expected_;
  std::vector<uint32_t> owners_;
  std::vector<uint32_t> owners_before_;  ///< carried to the places of this frame
  std::vector<uint32_t> region_ids_;     ///< object of each region
  std::vector<size_t> order_;            ///< regions, the largest first
  std::vector<Life> lives_;
  std::vector<MovingObject> objects_;
  uint32_t next_id_ = 1;
};

}  // namespace spidar
