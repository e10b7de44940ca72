// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/engine/track_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/force/motion_rendering.h"

namespace spidar::filter {
namespace {

/// A longer gap between frames is a gap in the samples, too.
constexpr int64_t kMaxMissing_ns = 500'000'000;

/// Backwards, the track is read in pieces of this length.
constexpr int64_t kPiece_ns = 4'000'000'000;
/// Up to this distance, the track is read on instead of seeking.
constexpr int64_t kNear_ns = ReadAhead::kAhead_ns;
/// How much is kept around a frame: for a step back, or a rate that changes.
constexpr int64_t kKept_ns = 1'000'000'000;

/// Returns the block without the samples at or after `time_ns`.
TrackBlock cut(TrackBlock block, int64_t time_ns) {
  size_t count = block.count;
  while (count > 0 && block.time_ns(count - 1) >= time_ns) --count;
  block.duration_ns = block.time_ns(count) - block.begin_ns;
  block.count = count;
  return block;
}

/// The stream time at which a frame is first shown: in reverse playback, its end.
int64_t first_ns(const FrameStamp& frame) {
  return frame.stream_ns + (frame.rate < 0 ? frame.length_ns : 0);
}

/// Converts a block from stream time to running time.
TrackBlock timed(const TrackBlock& block, const FrameStamp& frame) {
  TrackBlock shown = block;
  const auto running_at = [&frame](int64_t stream_ns) {
    return frame.running_ns +
           std::llround(static_cast<double>(stream_ns - first_ns(frame)) / frame.rate);
  };
  shown.duration_ns = std::max<int64_t>(
      std::llround(static_cast<double>(block.duration_ns) / std::fabs(frame.rate)), 1);
  if (frame.rate > 0) {
    shown.begin_ns = running_at(block.begin_ns);
  } else {
    shown.begin_ns = running_at(block.time_ns(block.count - 1));
    std::reverse(shown.samples.begin(), shown.samples.begin() + static_cast<int>(block.count));
  }
  return shown;
}

}  // namespace

void TrackReplay::set_track(std::shared_ptr<ReadAhead> track) {
  track_ = std::move(track);
  window_.clear();
  begin_ns_ = end_ns_ = 0;
  continues_ = true;
  late_ = false;
  epoch_.reset();
}

void TrackReplay::jump(int64_t time_ns) {
  track_->seek(time_ns);
  window_.clear();
  begin_ns_ = end_ns_ = time_ns;
  continues_ = true;
  late_ = false;
}

/// Appends the next block to the window. Returns false if there is none, or not yet.
bool TrackReplay::append() {
  const auto now = std::chrono::steady_clock::now();
  TrackBlock block;
  const ReadAhead::Found found = track_->pop(block, late_ ? now : now + kLongestWait);
  late_ = found == ReadAhead::Found::kLate;
  if (found == ReadAhead::Found::kEnd) end_ns_ = INT64_MAX;
  if (found != ReadAhead::Found::kBlock) return false;
  window_.push_back(block);
  end_ns_ = std::max(end_ns_, block.begin_ns);
  return true;
}

void TrackReplay::append_until(int64_t time_ns) {
  if (end_ns_ >= time_ns) return;
  if (!continues_) {
    const int64_t end_ns = window_.empty() ? end_ns_ : end_of(window_.back());
    track_->seek(end_ns);
    continues_ = true;
  }
  while (end_ns_ < time_ns && append()) {
  }
}

/// Reads the blocks before the window.
void TrackReplay::prepend(int64_t from_ns) {
  std::deque<TrackBlock> later = std::move(window_);
  const int64_t end_ns = end_ns_;
  const int64_t seam_ns = later.empty() ? begin_ns_ : std::min(begin_ns_, later.front().begin_ns);
  jump(std::max<int64_t>(from_ns - kPiece_ns, 0));
  append_until(seam_ns);
  if (end_ns_ < seam_ns) return;  // the block comes too late
  while (!window_.empty() && window_.back().begin_ns >= seam_ns) window_.pop_back();
  if (!window_.empty()) window_.back() = cut(window_.back(), seam_ns);
  window_.insert(window_.end(), later.begin(), later.end());
  end_ns_ = end_ns;
  continues_ = false;
}

/// Fills the window with the blocks between two times.
void TrackReplay::cover(int64_t from_ns, int64_t to_ns, bool backwards) {
  from_ns = std::max<int64_t>(from_ns, 0);
  const bool is_far = from_ns - kNear_ns > end_ns_;
  if (from_ns < begin_ns_ && backwards && to_ns >= begin_ns_ && !is_far) {
    prepend(from_ns);
  } else if (from_ns < begin_ns_ || is_far) {
    jump(backwards ? std::max<int64_t>(from_ns - kPiece_ns, 0) : from_ns);
  }
  append_until(to_ns);
}

void TrackReplay::clear_beyond(int64_t from_ns, int64_t to_ns) {
  while (window_.size() > 1 && end_of(window_.front()) < from_ns) {
    begin_ns_ = end_of(window_.front());
    window_.pop_front();
  }
  while (window_.size() > 1 && window_.back().begin_ns > to_ns) {
    end_ns_ = window_.back().begin_ns;
    window_.pop_back();
    continues_ = false;
  }
}

void TrackReplay::play(const FrameStamp& frame,
                       const std::function<void(const TrackBlock&)>& give) {
  if (!has_track() || frame.rate == 0 || !std::isfinite(frame.rate)) return;
  const int64_t at_ns = first_ns(frame);
  const bool is_anew = frame.epoch != epoch_;
  const bool is_gap = std::llabs(at_ns - expected_ns_) > kMaxMissing_ns;
  const bool backwards = frame.rate < 0;
  if (is_anew || is_gap || frame.rate != rate_) given_ns_ = at_ns;
  if (is_anew) late_ = false;
  epoch_ = frame.epoch;
  rate_ = frame.rate;
  const auto margin_ns = static_cast<int64_t>(static_cast<double>(kMargin_ns) * frame.rate);
  expected_ns_ = backwards ? frame.stream_ns : at_ns + frame.length_ns;
  const int64_t until_ns = expected_ns_ + margin_ns;
  if (backwards) {
    cover(until_ns, at_ns, true);
    // Blocks are given from the end, so give none while those at the end are missing.
    const bool is_whole = end_ns_ >= std::min(at_ns, given_ns_);
    for (auto block = window_.rbegin();
         is_whole && block != window_.rend() && end_of(*block) > until_ns; ++block) {
      if (block->begin_ns >= given_ns_) continue;
      give(timed(*block, frame));
      given_ns_ = block->begin_ns;
    }
    clear_beyond(until_ns - kPiece_ns, at_ns + kKept_ns);
  } else {
    cover(at_ns, until_ns, false);
    for (const TrackBlock& block : window_) {
      if (block.begin_ns >= until_ns) break;
      if (end_of(block) <= given_ns_) continue;
      give(timed(block, frame));
      given_ns_ = end_of(block);
    }
    clear_beyond(at_ns - kKept_ns, INT64_MAX);
  }
}

Wrench TrackReplay::largest(const FrameStamp& frame) const {
  const int64_t begin_ns = frame.stream_ns;
  const int64_t end_ns = begin_ns + std::max<int64_t>(frame.length_ns, 1);
  Wrench largest;
  for (const TrackBlock& block : window_) {
    if (end_of(block) <= begin_ns) continue;
    if (block.begin_ns >= end_ns) break;
    for (size_t i = 0; i < block.count && block.time_ns(i) < end_ns; ++i) {
      const Wrench wrench = to_wrench(block.samples[i]);
      if (block.time_ns(i + 1) > begin_ns && size_N(wrench) > size_N(largest)) largest = wrench;
    }
  }
  return largest;
}

void TrackRenderer::set_track(std::shared_ptr<ReadAhead> track, const std::string& path) {
  {
    const std::lock_guard<std::mutex> lock(path_mutex_);
    path_ = track ? std::make_shared<const std::string>(path) : nullptr;
  }
  replay_.set_track(std::move(track));
  frames_ = 0;
}

std::string TrackRenderer::path() const {
  const std::lock_guard<std::mutex> lock(path_mutex_);
  return path_ ? *path_ : "";
}

void TrackRenderer::begin_stream(const std::string& track, const std::string& film) {
  set_track(nullptr);
  felt_.reset();
  loader.begin(track, film);
}

void TrackRenderer::use_loaded(int64_t frame_ns, bool has_rules) {
  if (const std::optional<tracks::LoadedTrack> loaded = loader.take()) {
    // The scheduled wrenches of earlier frames stay: some of them may be the end of another film.
    if (auto blocks = felt_.judge(*loaded, frame_ns, has_rules)) {
      set_track(std::move(blocks), loaded->path);
    }
  }
  if (!felt_.check()) set_track(nullptr);
}

void TrackRenderer::play(const FrameStamp& stamp, FrameReport& report) {
  feed_.no_force.set_touching(false);
  FrameStamp shown = stamp;
  shown.running_ns = feed_.schedule.at_sink_ns(stamp.running_ns);
  shown.rate *= feed_.schedule.rate_multiplier();
  ++frames_;
  replay_.play(shown, [this](const TrackBlock& block) { feed_.track_samples.add(block); });
  report.frame.wrench = replay_.largest(shown);
  report.frame.interval_ns = stamp.length_ns;  // how long the frame is shown
  report.no_force = reason_in_track(report.frame.wrench, feed_.output.snapshot());
  const bool is_weak = report.no_force == NoForceReason::kTooWeak;
  feed_.no_force.add(shown.running_ns, is_weak ? Wrench() : report.frame.wrench, report.no_force);
}

void TrackRenderer::process(FrameReport& report) {
  report.track = path_;
  play(report.stamp, report);
  feed_.reliefs.end(feed_.schedule.at_sink_ns(report.stamp.running_ns));
}

void TrackRenderer::pass_gap(const FrameStamp& stamp) {
  FrameReport unread;
  play(stamp, unread);
}

}  // namespace spidar::filter
