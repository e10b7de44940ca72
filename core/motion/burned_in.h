// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What belongs to the screen and not to the film.
#pragma once

#include <cstdint>
#include <vector>

#include "core/field/block_field.h"

namespace spidar {

/// Tells blocks with something that is burned into the film (a logo, a subtitle, a clock, the edge
/// of a letterbox bar, a still picture in the picture) from blocks with something that moves. While
/// the camera moves, both move against the background.
///
/// What is burned in was put there after the film was taken. So its pixels stay the same without
/// the noise of the film, while those of something that the camera follows change, however well it
/// is followed. What is half transparent lets the film shine through: its edges stay in their
/// place, and still nothing explains its pixels, neither rest nor any motion. That alone may also
/// be the beginning of something that bends, so it is no sign where an object is known.
///
/// A film without noise, as a cartoon may be, gives no such sign: what stands exactly still on the
/// screen in front of a background that moves counts as burned in.
class BurnedIn {
 public:
  /// A block that differs from the background.
  struct Block {
    size_t index = 0;
    float background_x_px = 0;  ///< motion of the background at this place
    float background_y_px = 0;
    bool is_expected = false;  ///< it belongs to an object that is known
  };

  /// Begins a pair of pictures. `camera_moves`: where it does not, what stays is the scene.
  /// `noise_grey2`: mean squared difference that the noise of the film makes.
  void begin(size_t blocks, bool camera_moves, float noise_grey2);

  /// Looks at a block of that pair. To be called for those that seem to move by themselves.
  void look(const BlockField& field, const Block& block);

  /// Ends the pair: what has stayed twice counts for blocks beside it which nothing explains, and
  /// for some of the next pairs, in which the digits of a clock may change.
  void end(const BlockGrid& grid);

  /// Whether a block shows something that is burned in; false for what was not looked at in the
  /// latest pairs.
  bool holds(size_t index) const { return index < holds_.size() && holds_[index] != 0; }

  /// Whether what a block shows has lasted, or is beside what has: it covers the film, and nobody
  /// knows what is behind it. Rarer than holds(), for a sign in a single pair may be an error.
  bool covers(size_t index) const { return index < covers_.size() && covers_[index] != 0; }

  void reset();

 private:
  enum class Sign : uint8_t {
    kNone,
    kUnexplained,  ///< neither noise nor its own motion explains its pixels
    kInPlace,      ///< nor does it, and it has not moved
    kStays,        ///< its pixels are the same
  };

  bool stays_beside(const BlockField& field, const Block& block) const;
  bool is_beside_staying(const BlockGrid& grid, size_t index) const;

  std::vector<Sign> signs_;
  std::vector<uint8_t> lasting_;  ///< how much each block has stayed of late, 0 … kMost
  std::vector<uint8_t> holds_;
  std::vector<uint8_t> covers_;
  bool camera_moves_ = false;
  float unexplained_grey2_ = 0;
};

}  // namespace spidar
