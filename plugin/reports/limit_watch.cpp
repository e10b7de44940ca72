// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/reports/limit_watch.h"

#include <algorithm>

namespace spidar {
namespace {

/// When a hand swings a slack string, the pose is lost for less than this.
constexpr int64_t kGripLost_ns = 100'000'000;

/// Whether nothing was felt in the whole interval and no frame was due in it.
bool is_late(const LoopSnapshot& loop) {
  return loop.unfelt_ns >= NoForceHistory::kWindow_ns &&
         (loop.last.found == Found::kExpired || loop.last.found == Found::kNothing);
}

}  // namespace

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

NoForceReason limit_of_contact(const LoopSnapshot& loop, bool can_touch) {
  if (loop.unfelt_ns < NoForceHistory::kWindow_ns) return NoForceReason::kNone;
  if (!can_touch) return NoForceReason::kCannotTouch;
  const Contact& contact = loop.last.contact;
  if (!contact.has_surface) return NoForceReason::kNoRelief;
  return contact.touching ? NoForceReason::kLightTouch : NoForceReason::kNotTouching;
}

void LimitWatch::add(int64_t shown_ns, const Wrench& wrench, NoForceReason limit) {
  const std::lock_guard<std::mutex> lock(mutex_);
  frames_.add(shown_ns, size_N(wrench), limit);
  newest_ns_ = shown_ns;
}

void LimitWatch::forget() {
  const std::lock_guard<std::mutex> lock(mutex_);
  frames_.forget();
  newest_ns_ = 0;
}

void LimitWatch::set_muted(bool muted) {
  const std::lock_guard<std::mutex> lock(mutex_);
  muted_ = muted;
}

void LimitWatch::set_touching(bool touching) {
  const std::lock_guard<std::mutex> lock(mutex_);
  touching_ = touching;
}

void LimitWatch::set_can_touch(bool can_touch) {
  const std::lock_guard<std::mutex> lock(mutex_);
  can_touch_ = can_touch;
}

NoForceReason LimitWatch::limit(const std::optional<LoopSnapshot>& loop, bool up_to_screen) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!loop) {
    if (touching_) return NoForceReason::kNoDevice;
    const NoForceReason of_video = frames_.limit(newest_ns_);
    return of_video == NoForceReason::kNone ? NoForceReason::kNoDevice : of_video;
  }
  const NoForceReason of_device = limit_of_device(*loop, muted_);
  if (of_device != NoForceReason::kNone) return of_device;
  if (touching_) return limit_of_contact(*loop, can_touch_);
  const int64_t screen_ns = loop->last.running_ns;
  const int64_t now_ns = up_to_screen ? screen_ns : newest_ns_;
  const NoForceReason of_video = frames_.limit(now_ns);
  const bool due = now_ns <= screen_ns;
  return of_video == NoForceReason::kNone && due && is_late(*loop) ? NoForceReason::kLate
                                                                   : of_video;
}

void describe_limit(NoForceReason limit, GstStructure* structure) {
  gst_structure_set(structure, "limit", G_TYPE_STRING, nick(limit), nullptr);
  if (limit == NoForceReason::kNone) return;
  gst_structure_set(structure, "limit-reason", G_TYPE_STRING, sentence(limit), nullptr);
}

}  // namespace spidar
