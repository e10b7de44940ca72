// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string_view>

#include "core/analysis/frame.h"
#include "core/motion/image_motion.h"
#include "core/wrench.h"
#include "spidar/loop/tick_record.h"

namespace spidar {

/// Why nothing is felt: why the force is below kFeltForce_N, or has been lowered (kGripReleased,
/// kVibration). The reasons up to kEnded and those from kCannotTouch on do not depend on the film.
/// They concern the device, the playback or, while the picture is touched, the contact.
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
  kAreaUnknown,
  kNoFilm,
  kCameraUnknown,
  kCameraOnly,
  kObjectsOnly,
  kNothingMoves,
  kTooWeak,
  kSilentTrack,  ///< a haptic track replaces the video's motion
  // While the picture is touched:
  kCannotTouch,  ///< the device has no third axis
  kNoRelief,     ///< the picture has no surface
  kNotTouching,  ///< the grip is in front of the surface
  kLightTouch,   ///< the grip touches the surface too lightly
  kLate,
  kNoDevice,
};
constexpr size_t kNoForceReasons = static_cast<size_t>(NoForceReason::kNoDevice) + 1;

/// For programs: "none", "camera-only", …
const char* nick(NoForceReason reason) noexcept;
/// For people: a whole sentence. Empty for kNone.
const char* sentence(NoForceReason reason) noexcept;
/// The inverse of nick(); nothing for an unknown nick.
std::optional<NoForceReason> no_force_reason(std::string_view nick) noexcept;

/// The reason in the video, for one frame that was analysed for `motion`, with the rendered wrench.
NoForceReason reason_in_frame(const Frame& frame, MotionKind motion);

/// The reason in a haptic track with the largest force `wrench`. Without a device, `loop` is
/// nothing.
NoForceReason reason_in_track(const Wrench& wrench, const std::optional<LoopSnapshot>& loop);

/// A reason of the device or of the playback, which holds for any video; kNone when there is none.
/// That the device is off is no reason if no force was wanted: the next force switches it on.
NoForceReason reason_in_device(const LoopSnapshot& loop, bool muted);

/// Stores the latest frames and finds why there was no force in the last second. Not thread-safe.
/// Allocates nothing.
class NoForceHistory {
 public:
  static constexpr int64_t kWindow_ns = 1'000'000'000;
  /// Older frames are dropped. The capacity is a second at 60 frames/s and 16 s of waiting frames.
  static constexpr size_t kFrames = 1024;

  /// Adds a frame that is shown at `shown_ns`, with the magnitude of its force. Drops stored
  /// frames that are shown at that time or later.
  void add(int64_t shown_ns, double force_N, NoForceReason reason) noexcept;

  /// Returns why the frames shown in the second up to `now_ns` had no force: kNone if one of them
  /// has a force that is felt, kRepeatedFrames if all of them show the same picture, otherwise the
  /// reason of most pictures.
  NoForceReason reason(int64_t now_ns) const noexcept;

  void reset() noexcept { count_ = 0; }

 private:
  struct Shown {
    int64_t shown_ns = 0;
    double force_N = 0;
    NoForceReason reason = NoForceReason::kNone;
  };
  const Shown& latest(size_t i) const noexcept {
    return frames_[(next_ + 2 * kFrames - 1 - i) % kFrames];
  }

  std::array<Shown, kFrames> frames_{};
  size_t count_ = 0;
  size_t next_ = 0;
};

/// The reason in the contact of the last tick, when nothing has been felt for a second with `touch`
/// on; otherwise kNone. For `can_touch` see GripAbilities.
NoForceReason reason_in_contact(const LoopSnapshot& loop, bool can_touch);

class NoForceWatch {
 public:
  /// Adds a frame that the sink shows at the running time `shown_ns`, with its wrench, and the
  /// reason for one that is too weak to feel.
  void add(int64_t shown_ns, const Wrench& wrench, NoForceReason reason);
  /// Marks the newest frame as the last one, until another one is added.
  void end();
  /// Call this when running time restarts.
  void reset();
  void set_muted(bool muted) { muted_ = muted; }
  /// While the picture is touched, the hand feels the contact, not the film.
  void set_touching(bool touching) { touching_ = touching; }
  /// Whether the open device can touch, see GripAbilities.
  void set_can_touch(bool can_touch) { can_touch_ = can_touch; }

  /// The film's reason, of the last second up to the picture on the screen; without a device, up to
  /// the frame added last.
  NoForceReason of_film(const std::optional<LoopSnapshot>& loop) const;
  /// The reason of the device, the playback or the contact, now; kNone when there is none.
  NoForceReason of_device(const std::optional<LoopSnapshot>& loop) const;
  /// The reason to show to a person: the film's if it has one and has not ended, else the device's.
  NoForceReason first(const std::optional<LoopSnapshot>& loop) const;

 private:
  NoForceReason film(const std::optional<LoopSnapshot>& loop) const;
  NoForceReason device(const std::optional<LoopSnapshot>& loop) const;
  bool has_ended(const std::optional<LoopSnapshot>& loop) const;

  mutable std::mutex mutex_;
  NoForceHistory frames_;
  int64_t newest_ns_ = 0;
  bool is_last_ = false;  ///< whether the newest frame is the last one
  std::atomic<bool> muted_{false};
  std::atomic<bool> touching_{false};
  std::atomic<bool> can_touch_{true};
};

}  // namespace spidar
