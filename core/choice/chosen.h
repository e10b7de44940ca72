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
#include "core/motion/camera/background.h"
#include "core/motion/objects/moving_object.h"
#include "core/orientation.h"

namespace spidar {

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

/// Result of a request.
enum class ChoiceState {
  kGood,
  kNotThere,   ///< no object was at the position; the first that begins to move there is felt
  kNotSeen,    ///< playback began after the moment at which the object is at the position
  kLost,       ///< the object was followed and is lost
  kNoBox,      ///< no frame of the rule came with a box that it means
  kBoxAtRest,  ///< boxes came, but nothing moves in them
};

struct Chosen {
  std::optional<FeelRule> rule;  ///< of the moment
  bool is_kept = false;          ///< a click counts, and no rule
  ChoiceState state = ChoiceState::kGood;
  const MovingObject* object = nullptr;  ///< the one that is felt, when it is one

  /// Nothing of this: what `motion` says is felt.
  bool is_free() const { return !rule && !is_kept; }
};

/// What a choice needs of a frame. Places of rules and clicks are those of the picture as it is
/// shown.
struct ChoiceFrame {
  const std::vector<MovingObject>& objects;
  const Background* background;         ///< null when it is not known
  int width, height;                    ///< px
  double interval_s;                    ///< since the frame before; 0 when there is none
  bool is_cut;                          ///< nothing in it was in the frame before
  int64_t stream_ns;                    ///< position in the film
  Orientation turn;                     ///< of the frame before it is shown
  const PictureBoxes* boxes = nullptr;  ///< that came with it; null: none did

  /// A position of the picture as it is shown, from the middle of the frame.
  Eigen::Vector2d px(const Eigen::Vector2d& position) const {
    const Eigen::Vector2d coded = turn.stored_position(position);
    return {(coded.x() - 0.5) * width, (coded.y() - 0.5) * height};
  }
  /// The same of a box with these two corners.
  Eigen::AlignedBox2d px(const Eigen::Vector2d& corner, const Eigen::Vector2d& far_corner) const {
    return Eigen::AlignedBox2d(px(corner)).extend(px(far_corner));
  }
};

}  // namespace spidar
