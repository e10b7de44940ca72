// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What is asked of a choice, and its answer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/choice/feel_rules.h"

namespace spidar {

struct MovingObject;

/// A box that somebody else found in a picture: a detector or a tracker. Corners go from (0, 0),
/// the top left corner of the picture as it is shown, to (1, 1); a box may lie partly outside.
struct PictureBox {
  std::string name;                ///< of what is in it, "face"
  Eigen::Vector2d position{0, 0};  ///< the corner that is nearer to (0, 0)
  Eigen::Vector2d far_corner{1, 1};
};

using PictureBoxes = std::vector<PictureBox>;

/// An object that is kept because it was clicked.
struct KeptObject {
  uint32_t click = 0;              ///< counts the clicks; 0: none is kept
  Eigen::Vector2d position{0, 0};  ///< of the click
};

struct Chosen {
  /// Result of a request.
  enum class State {
    kGood,
    kNotThere,   ///< no object was at the position; the first that begins to move there is felt
    kNotSeen,    ///< playback began after the moment at which the object is at the position
    kLost,       ///< the object was followed and is lost
    kNoBox,      ///< no frame of the rule came with a box that it means
    kBoxAtRest,  ///< boxes came, but nothing moves in them
  };

  std::optional<FeelRule> rule;  ///< of the moment
  bool is_kept = false;          ///< a click counts, and no rule
  State state = State::kGood;
  const MovingObject* object = nullptr;  ///< the one that is felt, when it is one

  /// Nothing of this: what `motion` says is felt.
  bool is_free() const { return !rule && !is_kept; }
};

}  // namespace spidar
