// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The object that a box of somebody else is around.
#pragma once

#include <cstdint>

#include "core/choice/chosen.h"

namespace spidar {

/// Boxes say what is meant, objects how it moves. A detector misses things in some frames, so that
/// the object stays for a moment without a box. Of several, the largest is taken; it stays for as
/// long as there is a box around it.
class BoxedObject {
 public:
  /// By boxes of this name, or by all when it is empty. It outlives the frames up to the next
  /// begin().
  void begin(const char* name);

  /// Takes the next frame. The object, as it is in `frame`; null when none is known.
  const MovingObject* see(const ChoiceFrame& frame);

  /// All objects have other ids.
  void cut() { id_ = 0; }

  /// kNoBox or kBoxAtRest, where for kPatience_s no box was around an object; else kGood.
  ChoiceState state() const;

  /// So long the object stays without a box: a detector that looks at every tenth frame of 25 a
  /// second, as they do on slow machines, may miss it once.
  static constexpr double kHold_s = 0.8;
  /// No box of a new rule comes for so long before that is told.
  static constexpr double kPatience_s = 1;
  /// Box and object are the same thing when at least this share of the smaller of them is in the
  /// other: a face is a part of the person who moves, a leg that moves one of the person in the
  /// box.
  static constexpr double kOverlap = 0.5;

 private:
  const MovingObject* at_box(const PictureBox& box, const ChoiceFrame& frame) const;

  const char* name_ = "";
  uint32_t id_ = 0;  ///< of the object; 0: none
  double missing_s_ = 0;
  double waited_s_ = 0;  ///< since begin(), until the first one was found
  bool has_found_ = false;
  bool has_box_ = false;
};

}  // namespace spidar
