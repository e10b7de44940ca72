// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/frame/no_force_reason.h"

#include "core/force/gain_controller.h"
#include "core/force/motion_rendering.h"
#include "core/motion/cadence.h"
#include "core/motion/image_motion.h"

namespace spidar {
namespace {

/// What is slower than this, in px/s of a frame 480 lines high, does not count as moving
/// (docs/feeling.md).
constexpr double kMoving_px_s = 1;
/// With fewer points no motion can be told from the background's: a translation of the background
/// takes one of them, and an object two.
constexpr int kFewestPoints = 4;
/// When a hand swings a slack string, the pose is lost for less than this.
constexpr int64_t kGripLost_ns = 100'000'000;

struct Wording {
  const char* nick;
  const char* sentence;
};

Wording wording(NoForceReason limit) noexcept {
  switch (limit) {
    case NoForceReason::kNone:
      return {"none", ""};
    case NoForceReason::kDeviceLost:
      return {"device-lost", "The device does not answer. The force returns when it does."};
    case NoForceReason::kDeviceStarting:
      return {"device-starting", "The device is not running yet: its strings are being tightened."};
    case NoForceReason::kGripUnknown:
      return {"grip-unknown",
              "The device is at rest because of a fault: the position of the grip is not known."};
    case NoForceReason::kGripReleased:
      return {
          "grip-released",
          "Nobody holds the grip: it moved, spun or rested as only a released one does. The force "
          "returns by itself."};
    case NoForceReason::kVibration:
      return {"vibration",
              "The force is lowered because it has shaken the hand for long: a day's vibration is "
              "limited. Calm scenes are felt as before, and the force returns with time."};
    case NoForceReason::kMuted:
      return {"muted", "The force is muted (mute=true)."};
    case NoForceReason::kNotPlaying:
      return {"not-playing",
              "The video is not playing: it is paused, it is seeking, or its clock stands still."};
    case NoForceReason::kEnded:
      return {"ended", "The film has ended."};
    case NoForceReason::kNoFrames:
      return {"no-frames",
              "No frame was measured in the last second: the video stalls, or its frames have no "
              "timestamps."};
    case NoForceReason::kNothingToCompare:
      return {"nothing-to-compare",
              "There was nothing to compare a picture with: it is the first one, or each picture "
              "shows another scene."};
    case NoForceReason::kRepeatedFrames:
      return {"repeated-frames", "All frames of the last second show the same picture."};
    case NoForceReason::kFewPictures:
      return {"few-pictures",
              "The pictures come too seldom, less than six a second: hardly any motion can be "
              "followed from one to the next."};
    case NoForceReason::kTooFewPoints:
      return {"too-few-points", "The picture has too little texture to measure motion by."};
    case NoForceReason::kNotChosen:
      return {"not-chosen",
              "By what was chosen (feel, or a click with pointer=mouse), nothing is felt now: the "
              "rule says so, or its object is not in sight."};
    case NoForceReason::kCameraUnknown:
      return {"camera-unknown",
              "How the camera moves cannot be told: no motion explains more than a small part of "
              "the picture. What moves against the background is therefore unknown, too."};
    case NoForceReason::kCameraOnly:
      return {"camera-only",
              "Only the camera moves, and motion=object and motion=objects leave that out; with "
              "motion=camera it is felt."};
    case NoForceReason::kNothingMoves:
      return {"nothing-moves", "Nothing moves in the picture."};
    case NoForceReason::kTooWeak:
      return {"too-weak",
              "The force is weaker than a hand feels (0.04 N): the motion is slow, or alpha, "
              "depth-gain, roll-gain or max-force is small."};
    case NoForceReason::kSilentTrack:
      return {"silent-track",
              "The haptic track has no force here, or less than a hand feels (0.04 N)."};
    case NoForceReason::kCannotTouch:
      return {"cannot-touch",
              "This device cannot touch the picture: it gives no force towards the viewer, or does "
              "not measure how far the grip is from the picture. With touch=off the motion of the "
              "video is felt."};
    case NoForceReason::kNoRelief:
      return {"no-relief",
              "There is no surface to touch: no frame with a relief is on the screen, or the video "
              "has ended. With touch=depth, frames need depth."};
    case NoForceReason::kNotTouching:
      return {"not-touching",
              "The grip does not touch the surface: it is in front of it. Push it away from you, "
              "into the picture."};
    case NoForceReason::kLightTouch:
      return {"light-touch",
              "The grip touches the surface, but the force is weaker than a hand feels (0.04 N): "
              "press deeper, or touch-stiffness or max-force is small."};
    case NoForceReason::kLate:
      return {"late",
              "The frames come too late: their force is known only after they should have been "
              "shown."};
    case NoForceReason::kNoDevice:
      return {
          "no-device",
          "No device is open: device=none was set, or a warning has said why the device gives no "
          "force."};
  }
  return {"unknown", ""};
}

/// Whether what was chosen leaves nothing to feel.
bool is_withheld(const Frame& frame) {
  const Chosen& choice = frame.choice;
  if (choice.is_free()) return false;
  const bool is_one = choice.is_kept || choice.rule->kind == FeelKind::kObjectAt ||
                      choice.rule->kind == FeelKind::kBox;
  if (is_one) return frame.felt_object == 0;
  return choice.rule->kind == FeelKind::kNothing || choice.rule->gain == 0;
}

}  // namespace

const char* nick(NoForceReason limit) noexcept {
  return wording(limit).nick;
}

const char* sentence(NoForceReason limit) noexcept {
  return wording(limit).sentence;
}

NoForceReason limit_of(const Frame& frame, MotionKind motion) {
  if (frame.picture == PictureKind::kFirst) return NoForceReason::kNothingToCompare;
  if (size_N(frame.wrench) >= kFeltForce_N) return NoForceReason::kNone;
  if (is_again(frame.picture)) return NoForceReason::kRepeatedFrames;
  if (is_withheld(frame)) return NoForceReason::kNotChosen;
  if (frame.height > 0 &&
      reference_speeds_px_s(frame.motion, {}, frame.height).norm() >= kMoving_px_s) {
    return NoForceReason::kTooWeak;
  }
  if (frame.interval_ns > Cadence::kLongest_ns) return NoForceReason::kFewPictures;
  if (frame.features < kFewestPoints) return NoForceReason::kTooFewPoints;
  const bool leaves_out_camera =
      frame.choice.is_free() ? motion == MotionKind::kObject || motion == MotionKind::kObjects
                             : frame.choice.is_kept || frame.choice.rule->is_about_objects();
  const bool is_unknown = frame.background && frame.background->coverage == 0 &&
                          frame.features >= static_cast<int>(kLeastVotes);
  if (leaves_out_camera && is_unknown) return NoForceReason::kCameraUnknown;
  const bool camera_moves = frame.background && frame.background->model.kind != ModelKind::kStill;
  return leaves_out_camera && camera_moves ? NoForceReason::kCameraOnly
                                           : NoForceReason::kNothingMoves;
}

NoForceReason limit_of_track(const Wrench& wrench, const std::optional<LoopSnapshot>& loop) {
  if (size_N(wrench) < kFeltForce_N) return NoForceReason::kSilentTrack;
  // Before its first tick the loop has no limit to tell.
  const bool is_weak = loop && loop->counters.ticks > 0 && loop->last.max_force_N < kFeltForce_N;
  return is_weak ? NoForceReason::kTooWeak : NoForceReason::kNone;
}

NoForceReason limit_of_device(const LoopSnapshot& loop, bool muted) {
  switch (loop.last.device) {
    case DeviceState::kLost:
      return NoForceReason::kDeviceLost;
    case DeviceState::kOpening:
    case DeviceState::kClosing:
    case DeviceState::kClosed:
      return NoForceReason::kDeviceStarting;
    case DeviceState::kRunning:
    case DeviceState::kIdle:
      break;
  }
  if (loop.untrusted_ns > kGripLost_ns) return NoForceReason::kGripUnknown;
  if (muted) return NoForceReason::kMuted;
  if (!loop.last.playing) return NoForceReason::kNotPlaying;
  if (!loop.last.held) return NoForceReason::kGripReleased;
  return loop.vibration.lowered() ? NoForceReason::kVibration : NoForceReason::kNone;
}

}  // namespace spidar
