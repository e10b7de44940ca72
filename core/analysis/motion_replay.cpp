// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_replay.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/force/motion_bounds.h"

namespace spidar {
namespace {

/// At another rate, all is as if the film had been shown like that when it was measured.
void play_at(MeasuredFrame& frame, double rate) {
  const double faster = std::abs(rate);
  const auto shorter = [&](int64_t ns) {
    return std::max<int64_t>(std::llround(static_cast<double>(ns) / faster), kLeastInterval_ns);
  };
  frame.interval_ns = shorter(frame.interval_ns);
  frame.shown_for_ns = shorter(frame.shown_for_ns);
  frame.mean.velocity_px_s *= rate;
  for (MovingObject& object : frame.objects) {
    object.relative_px_s *= rate;
    object.on_screen_px_s *= rate;
    object.growth_1_s *= rate;
    object.roll_rad_s *= rate;
    object.noise_px_s *= faster;
  }
  if (frame.background && rate < 0) {
    frame.background->model.shift_px *= -1;
    frame.background->model.linear *= -1;
    frame.background->model.perspective_1_px *= -1;
  }
}

}  // namespace

void MotionReplay::set_file(std::shared_ptr<const MotionFile> file, int64_t later_ns) {
  file_ = std::move(file);
  later_ns_ = later_ns;
  last_.reset();
  by_time_.clear();
  if (!file_) return;
  for (size_t i = 0; i < file_->size(); ++i) {
    const MotionMoment moment = file_->moment(i);
    if (moment.kind != MomentKind::kNothing) by_time_.emplace_back(moment.stream_ns, i);
  }
  std::sort(by_time_.begin(), by_time_.end());
}

/// The one after the last, when it has this time; else the nearest.
std::optional<size_t> MotionReplay::find(int64_t stream_ns) const {
  const int64_t wanted_ns = stream_ns - later_ns_;
  const auto after =
      std::lower_bound(by_time_.begin(), by_time_.end(), std::make_pair(wanted_ns, size_t{0}));
  std::optional<size_t> found;
  int64_t off_ns = kMostOff_ns;
  for (auto it = after == by_time_.begin() ? after : after - 1; it != by_time_.end(); ++it) {
    const int64_t this_ns = std::llabs(it->first - wanted_ns);
    if (it->first > wanted_ns && this_ns > off_ns) break;
    const bool is_new = last_ && found && *found <= *last_ && it->second > *last_;
    if (this_ns > off_ns || (this_ns == off_ns && found && !is_new)) continue;
    found = it->second;
    off_ns = this_ns;
  }
  return found;
}

void MotionReplay::feed(size_t i, double rate) {
  if (i >= file_->size() || !is_frame(i)) return;
  file_->load(i, frame_);
  if (rate != 1 && frame_.shown != Shown::kWaiting && frame_.shown != Shown::kFirst) {
    play_at(frame_, rate);
  }
  latest_ = renderer_.render(frame_);
}

/// The next frame follows nothing.
void MotionReplay::begin() {
  frame_ = {};
  frame_.anew = true;
  latest_ = renderer_.render(frame_);
}

std::optional<FrameAnalysis> MotionReplay::at(int64_t stream_ns, double rate) {
  const std::optional<size_t> now = find(stream_ns);
  if (!now) return std::nullopt;
  turn_ = file_->moment(*now).turn;
  AnalyzerSettings settings = settings_;
  settings.pointer = turn_.place_coded(settings.pointer);
  renderer_.configure(settings);
  if (last_ == now) {  // it is shown again
    frame_.shown = Shown::kWaiting;
    frame_.anew = false;
    latest_ = renderer_.render(frame_);
    return latest_;
  }
  // Backwards, what happens between two frames is in the later one.
  const bool backwards = rate < 0;
  const size_t left_out = !last_ ? SIZE_MAX : backwards ? *last_ - *now : *now - *last_;
  if (left_out > kMostLeftOut) {
    begin();
    feed(backwards ? *now + 1 : *now, rate);
    last_ = now;
  }
  while (last_ != now) feed(backwards ? (*last_)-- : ++*last_, rate);
  if (!is_frame(*now)) return std::nullopt;
  return latest_;
}

}  // namespace spidar
