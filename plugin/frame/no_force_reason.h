// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Why no force is felt, and the words for it.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace spidar {

/// What keeps the force below kFeltForce_N, or lowers it (kGripReleased, kVibration). The reasons
/// up to kEnded and those from kCannotTouch on are of the device, the playback or, while
/// touching, the contact, and hold for any film; the others are the film's.
enum class NoForceReason {
  kNone,  ///< there is a force
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
  kObjectsOnly,
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
const char* nick(NoForceReason reason) noexcept;
/// For people: a whole sentence. Empty for kNone.
const char* sentence(NoForceReason reason) noexcept;
/// The inverse of nick(); nothing for what is none.
std::optional<NoForceReason> no_force_reason(std::string_view nick) noexcept;

}  // namespace spidar
