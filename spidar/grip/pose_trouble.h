// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Why the pose of the grip is not known.
#pragma once

namespace spidar {

enum class PoseTrouble {
  kNone,
  kNotYet,     ///< too few good poses in a row since the device was opened or the pose was lost
  kNoReading,  ///< the device did not answer
  kNoFit,      ///< the string lengths fit no pose
  kJump,       ///< a pose that a hand could not have reached since the last one
  kOutside,    ///< a pose outside the frame, or turned so far that the strings would tangle
  kNotHomed,   ///< encoders have not passed their marks since the device was switched on
  kFrozen,     ///< no counter moves, although the force on the grip has changed
};

/// For messages: "the string lengths fit no pose", …
constexpr const char* to_string(PoseTrouble trouble) noexcept {
  switch (trouble) {
    case PoseTrouble::kNone:
      return "none";
    case PoseTrouble::kNotYet:
      return "too few good readings in a row";
    case PoseTrouble::kNoReading:
      return "the device does not answer";
    case PoseTrouble::kNoFit:
      return "the string lengths fit no pose";
    case PoseTrouble::kJump:
      return "the grip seems to move faster than a hand can";
    case PoseTrouble::kOutside:
      return "the grip seems to be outside the frame or turned right round";
    case PoseTrouble::kNotHomed:
      return "the device does not know its zero: pull the grip all the way out, then push it all "
             "the way in";
    case PoseTrouble::kFrozen:
      return "no encoder counts, although the force has changed";
  }
  return "unknown";
}

}  // namespace spidar
