// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Explains why no force is felt.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/motion/scene_motion.h"
#include "core/wrench.h"

namespace spidar {

struct FrameAnalysis;

/// The smallest force that a hand feels, the mean of wrist, elbow and shoulder: IEEE Trans. Haptics
/// 2013, PubMed 24808327.
constexpr double kFeltForce_N = 0.04;

/// What keeps the force below kFeltForce_N, or lowers it (kGripReleased, kVibration). The reasons
/// up to kNoFrames concern the device and the playback and hold for any video; the others concern
/// the video or, while touching, the contact.
enum class NoForceReason {
  kNone,  ///< the force is not limited
  kDeviceLost,
  kDeviceStarting,
  kGripUnknown,
  kGripReleased,
  kVibration,
  kMuted,
  kNotPlaying,
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

/// Size of a wrench as one force, with torque divided by the arm kTorqueArm_m (see
/// render_motion()).
double size_N(const Wrench& wrench) noexcept;

/// The reason in the video, for one frame that was analysed for `motion`.
NoForceReason limit_of(const FrameAnalysis& frame, MotionKind motion);

/// Keeps the latest frames and finds what limited the force in the last second. Not thread-safe.
/// Allocates nothing.
class NoForceHistory {
 public:
  static constexpr int64_t kWindow_ns = 1'000'000'000;
  /// Older frames are dropped. Room for a second at 60 frames/s and 16 s of frames that wait to be
  /// shown.
  static constexpr size_t kFrames = 1024;

  /// Adds a frame that is shown at `shown_ns`, with the size of its force. Frames that were added
  /// before and are not earlier are dropped.
  void add(int64_t shown_ns, double force_N, NoForceReason limit) noexcept;

  /// Of the frames shown in the second up to `now_ns`: kNone when one of them has a force that is
  /// felt; kRepeatedFrames when all of them show the same picture; else the reason that most
  /// pictures have.
  NoForceReason limit(int64_t now_ns) const noexcept;

  void forget() noexcept { count_ = 0; }

 private:
  struct Frame {
    int64_t shown_ns = 0;
    double force_N = 0;
    NoForceReason limit = NoForceReason::kNone;
  };
  const Frame& latest(size_t i) const noexcept {
    return frames_[(next_ + 2 * kFrames - 1 - i) % kFrames];
  }

  std::array<Frame, kFrames> frames_{};
  size_t count_ = 0;
  size_t next_ = 0;
};

}  // namespace spidar
