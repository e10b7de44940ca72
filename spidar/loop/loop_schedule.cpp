// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/loop/loop_schedule.h"

#include <utility>

namespace spidar {

void LoopSchedule::clear(uint32_t generation) noexcept {
  timeline_.clear();
  track_.clear();
  timeline_generation_ = generation;
  look_ahead_.reset();
  known_ns_ = INT64_MIN;
  newest_ns_ = INT64_MIN;
  reached_ns_ = INT64_MIN;
  motion_late_ns_ = 0;
}

/// Whether an entry was scheduled after a flush that has just taken place: it is for the next tick.
bool LoopSchedule::is_of_the_future(uint32_t generation) const noexcept {
  return static_cast<int32_t>(generation - timeline_generation_) > 0;  // the number wraps around
}

void LoopSchedule::take_wrenches(bool playing, int64_t running_ns) noexcept {
  while (const auto* next = wrenches_.front()) {
    if (next->generation == timeline_generation_) {
      known_ns_ = std::max(known_ns_, next->entry.motion_ns());
      const bool soon = timeline_.size() < 2 || before_newest_ns_ - kHorizon_ns <= running_ns;
      // At a high frame rate there are more frames within the horizon than fit into the timeline,
      // which would drop the frame that is on the screen.
      const bool has_room = timeline_.size_after(running_ns) < WrenchTimeline::kCapacity / 2;
      if (!playing || !soon || !has_room) return;
      const bool holds_on = next->entry.repeated && timeline_.size() > 0;
      if (holds_on) {
        timeline_.push(next->entry);
      } else if (timeline_.push(next->entry)) {
        before_newest_ns_ = newest_ns_;
        newest_ns_ = next->entry.time_ns;
      } else {
        ++refused_;
      }
    } else if (is_of_the_future(next->generation)) {
      return;
    }
    wrenches_.drop();
  }
}

TimelineResult LoopSchedule::read_track(bool playing, int64_t running_ns) noexcept {
  const TrackBlock* next = nullptr;
  while (const auto* oldest = blocks_.front()) {
    if (is_of_the_future(oldest->generation)) break;
    if (oldest->generation == timeline_generation_) {
      if (!playing) break;
      next = track_.read(oldest->entry, running_ns) ? nullptr : &oldest->entry;
      if (next) break;
    }
    blocks_.drop();
  }
  return playing ? track_.at(running_ns, next) : TimelineResult();
}

/// If the oldest block ends later than the requested time, all earlier ones have been read.
int64_t LoopSchedule::time_to_ask_for(int64_t running_ns, int64_t lag_ns) noexcept {
  const auto* const block = blocks_.front();
  if (block && block->generation == timeline_generation_) {
    known_ns_ = std::max(known_ns_, block->entry.time_ns(block->entry.count));
  }
  if (known_ns_ == INT64_MIN) return running_ns + lag_ns;
  return look_ahead_.ask_for(running_ns, lag_ns, known_ns_);
}

TimelineResult LoopSchedule::find(bool playing, int64_t running_ns, int64_t lag_ns) noexcept {
  const uint32_t generation = generation_.load(std::memory_order_acquire);
  if (generation != timeline_generation_) clear(generation);
  take_wrenches(playing, running_ns + lag_ns);
  const int64_t asked_ns = playing ? time_to_ask_for(running_ns, lag_ns) : running_ns;
  const TimelineResult of_track = read_track(playing, asked_ns);
  if (!playing) return {};
  const TimelineResult of_frames = timeline_.at(asked_ns);
  // After a film with a track there may be one without: its frames come later than every sample.
  const bool track_is_over =
      of_track.found == Found::kExpired && of_frames.frame_time_ns > of_track.frame_time_ns;
  const bool has_track = of_track.found != Found::kNothing && !track_is_over;
  const TimelineResult& result = has_track ? of_track : of_frames;
  if (result.found != Found::kNothing && result.frame_time_ns != reached_ns_) {
    reached_ns_ = result.frame_time_ns;
    skew_.add(running_ns + lag_ns - reached_ns_);
    motion_late_ns_ = result.late_ns;
  }
  return result;
}

uint64_t LoopSchedule::take_refused() noexcept {
  return std::exchange(refused_, 0);
}

}  // namespace spidar
