// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which parts of the picture move by themselves.
#pragma once

#include <cstdint>
#include <vector>

#include "core/field/block_field.h"
#include "core/motion/background.h"
#include "core/motion/burned_in.h"

namespace spidar {

/// What is known of a block beside its own motion. Lengths in pixels of the field's picture.
struct RelativeBlock {
  float x_px = 0;  ///< motion against the background
  float y_px = 0;
  float background_x_px = 0;  ///< motion of the background at this place
  float background_y_px = 0;
  bool has_texture = false;  ///< enough to say how it moves
  bool is_new = false;       ///< most of it was outside of the picture before
  bool is_covered = false;   ///< something that is burned in hides the film, see BurnedIn::covers()
  bool moves = false;        ///< by itself, its neighbours considered
};

/// Compares each block with the background. A block moves by itself when its motion differs from
/// the background's by more than noise, and the background's motion would explain its pixels
/// clearly worse than its own does. Single blocks that stand out are errors unless they last, and
/// textureless ones do as most of those around them.
class MovingBlocks {
 public:
  /// `expected`: blocks that something was on in the frame before and is now on, 1 or 0 each: these
  /// need less to count.
  const std::vector<RelativeBlock>& find(const BlockField& field, const Background& background,
                                         const std::vector<uint8_t>& expected);

  /// How likely each block moves by itself, from the frames so far, 0 … 1, each place carried along
  /// with the motion of what is on it.
  const std::vector<float>& persistence() const { return persistence_; }

  /// What belongs to the screen: it says neither how the camera nor how anything else moves.
  const BurnedIn& burned_in() const { return burned_in_; }

  void reset();

 private:
  enum class Judgement : uint8_t { kStill, kMoves, kUnknown, kBurnedIn };

  void compare(const BlockField& field, const Background& background);
  Judgement judge(const BlockField& field, size_t index, double noise_px, bool expected) const;
  void leave_out_burned_in(const BlockField& field, const std::vector<uint8_t>& expected);
  void ask_neighbours(const BlockGrid& grid);
  void remember_judgements(const BlockField& field);
  void remember_motion(const BlockField& field);

  std::vector<RelativeBlock> relative_;
  std::vector<Judgement> judgements_;
  std::vector<float> persistence_;
  std::vector<float> persistence_before_;
  std::vector<float> stood_out_;
  std::vector<float> stood_out_before_;
  std::vector<float> residuals_;
  BurnedIn burned_in_;
  bool camera_is_still_ = true;
  float picture_noise_ = 0;  ///< mean squared difference of what is explained best, grey²
};

/// Block of the frame before that was where block `index` has come from, the nearest of the grid.
size_t origin_of(const BlockField& field, size_t index);

}  // namespace spidar
