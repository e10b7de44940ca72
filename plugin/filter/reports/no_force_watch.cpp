// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/reports/no_force_watch.h"

#include <algorithm>

#include "core/force/motion_rendering.h"

namespace spidar {
namespace {

/// Whether nothing was felt in the whole interval and no frame was due in it.
bool is_late(const LoopSnapshot& loop) {
  return loop.unfelt_ns >= NoForceHistory::kWindow_ns &&
         (loop.last.found == Found::kExpired || loop.last.found == Found::kNothing);
}

}  // namespace

NoForceReason limit_of_contact(const LoopSnapshot& loop, bool can_touch) {
  if (loop.unfelt_ns < NoForceHistory::kWindow_ns) return NoForceReason::kNone;
  if (!can_touch) return NoForceReason::kCannotTouch;
  const Contact& contact = loop.last.contact;
  if (!contact.has_surface) return NoForceReason::kNoRelief;
  return contact.touching ? NoForceReason::kLightTouch : NoForceReason::kNotTouching;
}

void NoForceHistory::add(int64_t shown_ns, double force_N, NoForceReason limit) noexcept {
  if (count_ > 0 && shown_ns <= latest(0).shown_ns) forget();
  frames_[next_] = {shown_ns, force_N, limit};
  next_ = (next_ + 1) % kFrames;
  count_ = std::min(count_ + 1, kFrames);
}

NoForceReason NoForceHistory::limit(int64_t now_ns) const noexcept {
  std::array<size_t, kNoForceReasons> pictures{};
  bool repeats = false;
  for (size_t i = 0; i < count_; ++i) {
    const Frame& frame = latest(i);
    if (frame.shown_ns > now_ns) continue;
    if (frame.shown_ns <= now_ns - kWindow_ns) break;
    if (frame.force_N >= kFeltForce_N) return NoForceReason::kNone;
    if (frame.limit == NoForceReason::kRepeatedFrames) {
      repeats = true;
    } else {
      ++pictures[static_cast<size_t>(frame.limit)];
    }
  }
  // What had nothing to be compared with says nothing where others do.
  size_t& incomparable = pictures[static_cast<size_t>(NoForceReason::kNothingToCompare)];
  const bool any_incomparable = incomparable > 0;
  incomparable = 0;
  const auto most = std::max_element(pictures.begin(), pictures.end());
  if (*most > 0) return static_cast<NoForceReason>(most - pictures.begin());
  if (repeats) return NoForceReason::kRepeatedFrames;
  return any_incomparable ? NoForceReason::kNothingToCompare : NoForceReason::kNoFrames;
}

void NoForceWatch::add(int64_t shown_ns, const Wrench& wrench, NoForceReason limit) {
  const std::lock_guard<std::mutex> lock(mutex_);
  frames_.add(shown_ns, size_N(wrench), limit);
  newest_ns_ = shown_ns;
  is_last_ = false;
}

void NoForceWatch::end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_last_ = true;
}

void NoForceWatch::forget() {
  const std::lock_guard<std::mutex> lock(mutex_);
  frames_.forget();
  newest_ns_ = 0;
  is_last_ = false;
}

void NoForceWatch::set_muted(bool muted) {
  const std::lock_guard<std::mutex> lock(mutex_);
  muted_ = muted;
}

void NoForceWatch::set_touching(bool touching) {
  const std::lock_guard<std::mutex> lock(mutex_);
  touching_ = touching;
}

void NoForceWatch::set_can_touch(bool can_touch) {
  const std::lock_guard<std::mutex> lock(mutex_);
  can_touch_ = can_touch;
}

NoForceReason NoForceWatch::film(const std::optional<LoopSnapshot>& loop) const {
  return frames_.limit(loop ? loop->last.running_ns : newest_ns_);
}

/// The last frame is on the screen. Without a device, nothing says when that is.
bool NoForceWatch::has_ended(const std::optional<LoopSnapshot>& loop) const {
  return is_last_ && (!loop || loop->last.running_ns >= newest_ns_);
}

NoForceReason NoForceWatch::device(const std::optional<LoopSnapshot>& loop) const {
  if (!loop) return NoForceReason::kNoDevice;
  const NoForceReason reason = limit_of_device(*loop, muted_);
  const bool is_at_rest = reason == NoForceReason::kNone || reason == NoForceReason::kNotPlaying;
  if (is_at_rest && has_ended(loop)) return NoForceReason::kEnded;
  if (reason != NoForceReason::kNone) return reason;
  if (touching_) return limit_of_contact(*loop, can_touch_);
  // Of frames that come too late, none may be due in the last second.
  const int64_t due_ns = std::min(newest_ns_, loop->last.running_ns);
  const bool was_due = frames_.limit(due_ns) == NoForceReason::kNone;
  return was_due && is_late(*loop) ? NoForceReason::kLate : NoForceReason::kNone;
}

NoForceReason NoForceWatch::of_film(const std::optional<LoopSnapshot>& loop) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return film(loop);
}

NoForceReason NoForceWatch::of_device(const std::optional<LoopSnapshot>& loop) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return device(loop);
}

NoForceReason NoForceWatch::first(const std::optional<LoopSnapshot>& loop) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (has_ended(loop)) return NoForceReason::kEnded;
  const NoForceReason of_device = device(loop);
  if (touching_) return of_device;
  const NoForceReason of_film = film(loop);
  // That no frame is there may be because of the device.
  const bool has_own = of_film != NoForceReason::kNone && of_film != NoForceReason::kNoFrames;
  return has_own || of_device == NoForceReason::kNone ? of_film : of_device;
}

}  // namespace spidar
