// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Explains why no force is felt.
#pragma once

#include <cstddef>
#include <optional>

#include "core/analysis/frame.h"
#include "core/motion/image_motion.h"
#include "spidar/loop/tick_record.h"

namespace spidar {

/// What keeps the force below kFeltForce_N, or lowers it (kGripReleased, kVibration). The reasons
/// up to kEnded and those from kCannotTouch on are of the device, the playback or, while
/// touching, the contact, and hold for any film; the others are the film's.
enum class NoForceReason {
  kNone,  ///< the force is not limited
  kDeviceLost,
  kDeviceStarting,
  kGripUnknown,
  kGripReleased,
  kVibration,
  kMuted,
  kNotPlaying,
  kEnded,
  kNoFrames,
  kNothingToCompare,
  kRepeatedFrames,
  kFewPictures,
  kTooFewPoints,
  kNotChosen,
  kCameraUnknown,
  kCameraOnly,
  kNothingMoves,
  kTooWeak,
  kSilentTrack,  ///< a haptic track is played in place of the video's motion
  kCannotTouch,  ///< these four while touching: the device has no third axis,
  kNoRelief,     ///< there is no surface,
  kNotTouching,  ///< the grip is in front of it,
  kLightTouch,   ///< or touches it too lightly
  kLate,
  kNoDevice,
};
constexpr size_t kNoForceReasons = static_cast<size_t>(NoForceReason::kNoDevice) + 1;

/// For programs: "none", "camera-only", …
const char* nick(NoForceReason limit) noexcept;
/// For people: a whole sentence. Empty for kNone.
const char* sentence(NoForceReason limit) noexcept;

/// The reason in the video, for one frame that was analysed for `motion`.
NoForceReason limit_of(const Frame& frame, MotionKind motion);

/// The reason in a haptic track, where its largest force is `wrench`. `loop` is nothing while no
/// device is open.
NoForceReason limit_of_track(const Wrench& wrench, const std::optional<LoopSnapshot>& loop);

/// A reason of the device or of the playback, which holds whatever the video shows; kNone when
/// there is none. A device that is off because nothing was to be felt for minutes is none: it comes
/// back with the force.
NoForceReason limit_of_device(const LoopSnapshot& loop, bool muted);

}  // namespace spidar
