// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/motion_replay.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

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
    object.error_px_s *= faster;
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
  const size_t shown = rate < 0 && i > 0 ? i - 1 : i;
  latest_ = renderer_.render(frame_, place_of(shown));
}

FilmPlace MotionReplay::place_of(size_t i) const {
  const MotionMoment moment = file_->moment(i);
  return {moment.stream_ns + later_ns_, moment.turn};
}

void MotionReplay::configure(const AnalyzerSettings& settings) {
  recalls_ |= settings.feel != settings_.feel;
  settings_ = settings;
}

const FeelRule* MotionReplay::rule_at(size_t i) const {
  if (!settings_.feel || i >= file_->size()) return nullptr;
  return settings_.feel->at(place_of(i).stream_ns);
}

/// Lets the rule of the frame `end` see all frames before that it is about.
void MotionReplay::recall(size_t end) {
  const FeelRule* const rule = rule_at(end);
  // Boxes come with the frame that is shown, and nobody knows those of earlier ones.
  if (!rule || !rule->is_about_objects() || rule->kind == FeelKind::kBox) return;
  const int64_t from_ns = rule->from_ns - later_ns_;
  const int64_t end_ns = file_->moment(end).stream_ns;
  MeasuredFrame frame;
  for (auto it =
           std::lower_bound(by_time_.begin(), by_time_.end(), std::make_pair(from_ns, size_t{0}));
       it != by_time_.end() && it->first < end_ns; ++it) {
    if (!is_frame(it->second)) continue;
    file_->load(it->second, frame);
    renderer_.recall(frame, place_of(it->second));
  }
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
    recall(*now);
    feed(backwards ? *now + 1 : *now, rate);
    last_ = now;
  } else if (recalls_ || (backwards && rule_at(*now) != rule_at(*last_))) {
    recall(backwards ? *now : *last_ + 1);
  }
  recalls_ = false;
  while (last_ != now) feed(backwards ? (*last_)-- : ++*last_, rate);
  if (!is_frame(*now)) return std::nullopt;
  return latest_;
}

}  // namespace spidar
