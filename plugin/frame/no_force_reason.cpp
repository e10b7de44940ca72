// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/no_force_reason.h"

#include <algorithm>
#include <iterator>

namespace spidar {
namespace {

struct Wording {
  const char* nick;
  const char* sentence;
};

/// In the order of the enumeration.
constexpr Wording kWordings[] = {
    {"none", ""},
    {"device-lost", "The device does not answer. The force returns when it does."},
    {"device-starting", "The device is not running yet: its strings are being tightened."},
    {"grip-unknown",
     "The device is at rest because of a fault: the position of the grip is not known."},
    {"grip-released",
     "Nobody holds the grip: it moved, spun or rested as only a released one does. The force "
     "returns by itself."},
    {"vibration",
     "The force is lowered because it has shaken the hand for long: a day's vibration is limited. "
     "Calm scenes are felt as before, and the force returns with time."},
    {"muted", "The force is muted (mute=true)."},
    {"not-playing",
     "The video is not playing: it is paused, it is seeking, or its clock stands still."},
    {"ended", "The film has ended."},
    {"no-frames",
     "No frame was measured in the last second: the video stalls, or its frames have no "
     "timestamps."},
    {"nothing-to-compare",
     "There was nothing to compare a picture with: it is the first one, or each picture shows "
     "another scene."},
    {"repeated-frames", "All frames of the last second show the same picture."},
    {"few-pictures",
     "The pictures come too seldom, less than six a second: hardly any motion can be followed from "
     "one to the next."},
    {"too-few-points", "The picture has too little texture to measure motion by."},
    {"not-chosen",
     "By what was chosen (feel, or a click with pointer=mouse), nothing is felt now: the rule says "
     "so, or its object is not in sight."},
    {"camera-unknown",
     "How the camera moves cannot be told: no motion explains more than a small part of the "
     "picture. What moves against the background is therefore unknown, too."},
    {"camera-only",
     "Only the camera moves, and motion=object and motion=objects leave that out; with "
     "motion=camera it is felt."},
    {"objects-only",
     "The camera rests and only objects move, which motion=camera leaves out; with motion=object "
     "they are felt."},
    {"nothing-moves", "Nothing moves in the picture."},
    {"too-weak",
     "The force is weaker than a hand feels (0.04 N): the motion is slow, or alpha, depth-gain, "
     "roll-gain, max-force or, with touch, motion-fraction is small."},
    {"silent-track", "The haptic track has no force here, or less than a hand feels (0.04 N)."},
    {"cannot-touch",
     "This device cannot touch the picture: it gives no force towards the viewer, or does not "
     "measure how far the grip is from the picture. With touch=off the motion of the video is "
     "felt."},
    {"no-relief",
     "There is no surface to touch: no frame with a relief is on the screen, or the video has "
     "ended. With touch=depth, frames need depth."},
    {"not-touching",
     "The grip does not touch the surface: it is in front of it. Push it away from you, into the "
     "picture."},
    {"light-touch",
     "The grip touches the surface, but the force is weaker than a hand feels (0.04 N): press "
     "deeper, or touch-stiffness or max-force is small."},
    {"late",
     "The frames come too late: their force is known only after they should have been shown."},
    {"no-device",
     "No device is open: device=none was set, or a warning has said why the device gives no "
     "force."},
};
static_assert(std::size(kWordings) == kNoForceReasons);

}  // namespace

const char* nick(NoForceReason reason) noexcept {
  return kWordings[static_cast<size_t>(reason)].nick;
}

const char* sentence(NoForceReason reason) noexcept {
  return kWordings[static_cast<size_t>(reason)].sentence;
}

std::optional<NoForceReason> no_force_reason(std::string_view nick) noexcept {
  const Wording* const found =
      std::find_if(std::begin(kWordings), std::end(kWordings),
                   [nick](const Wording& wording) { return wording.nick == nick; });
  if (found == std::end(kWordings)) return std::nullopt;
  return static_cast<NoForceReason>(found - std::begin(kWordings));
}

}  // namespace spidar
