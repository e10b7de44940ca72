// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/engine/track_source.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#include "core/force/motion_rendering.h"
#include "plugin/timing/frame_pacer.h"

namespace spidar {
namespace {

/// Frames up to this far apart are consecutive, even if timestamps are rounded or a frame is
/// missing.
constexpr int64_t kJump_ns = 500'000'000;

int64_t end_of(const TrackBlock& block) {
  return block.begin_ns + block.duration_ns;
}

/// Where the video is with `frame`, of which the sink shows the beginning, or the end when it is
/// played backwards, at `running_ns`. Nothing when the segment does not show it.
std::optional<FramePlace> place_of(GstBuffer* frame, GstClockTime default_duration,
                                   const GstSegment& segment, int64_t running_ns,
                                   double rate_multiplier) {
  const GstClockTime pts = GST_BUFFER_PTS(frame);
  GstClockTime duration = GST_BUFFER_DURATION(frame);
  if (!GST_CLOCK_TIME_IS_VALID(duration)) duration = default_duration;
  guint64 from = 0, to = 0;
  if (!gst_segment_clip(&segment, GST_FORMAT_TIME, pts, pts + duration, &from, &to)) {
    return std::nullopt;
  }
  const bool backwards = segment.rate < 0;
  FramePlace place;
  place.stream_ns = static_cast<int64_t>(
      gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, backwards ? to : from));
  place.running_ns = running_ns;
  place.length_ns = static_cast<int64_t>(to - from);
  place.rate = segment.rate * rate_multiplier;
  return place;
}

}  // namespace

/// The first block that ends after `stream_ns`.
size_t TrackReplay::block_at(int64_t stream_ns) const {
  const auto ends_before = [](const TrackBlock& block, int64_t time_ns) {
    return end_of(block) <= time_ns;
  };
  const auto found =
      std::lower_bound(track_.blocks.begin(), track_.blocks.end(), stream_ns, ends_before);
  return static_cast<size_t>(found - track_.blocks.begin());
}

TrackBlock TrackReplay::timed(const TrackBlock& block, const FramePlace& frame) const {
  TrackBlock shown = block;
  const auto running_at = [&frame](int64_t stream_ns) {
    return frame.running_ns +
           std::llround(static_cast<double>(stream_ns - frame.stream_ns) / frame.rate);
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

void TrackReplay::play(const FramePlace& frame,
                       const std::function<void(const TrackBlock&)>& give) {
  if (!has_track() || frame.rate == 0 || !std::isfinite(frame.rate)) return;
  const bool jumped = std::llabs(frame.stream_ns - expected_ns_) > kJump_ns;
  const bool backwards = frame.rate < 0;
  if (!follows_ || jumped || frame.rate != rate_) {
    const size_t at = block_at(frame.stream_ns);
    next_ = backwards ? std::min(at + 1, track_.blocks.size()) : at;
  }
  follows_ = true;
  rate_ = frame.rate;
  const auto margin_ns = static_cast<int64_t>(static_cast<double>(kMargin_ns) * frame.rate);
  expected_ns_ = frame.stream_ns + (backwards ? -frame.length_ns : frame.length_ns);
  const int64_t until_ns = expected_ns_ + margin_ns;
  if (backwards) {
    for (; next_ > 0 && end_of(track_.blocks[next_ - 1]) > until_ns; --next_) {
      give(timed(track_.blocks[next_ - 1], frame));
    }
  } else {
    for (; next_ < track_.blocks.size() && track_.blocks[next_].begin_ns < until_ns; ++next_) {
      give(timed(track_.blocks[next_], frame));
    }
  }
}

Wrench TrackReplay::largest(const FramePlace& frame) const {
  const int64_t other_ns = frame.stream_ns + (frame.rate < 0 ? -frame.length_ns : frame.length_ns);
  const int64_t begin_ns = std::min(frame.stream_ns, other_ns);
  const int64_t end_ns = std::max({frame.stream_ns, other_ns, begin_ns + 1});
  Wrench largest;
  for (size_t at = block_at(begin_ns);
       at < track_.blocks.size() && track_.blocks[at].begin_ns < end_ns; ++at) {
    const TrackBlock& block = track_.blocks[at];
    for (size_t i = 0; i < block.count && block.time_ns(i) < end_ns; ++i) {
      const Wrench wrench = to_wrench(block.samples[i]);
      if (block.time_ns(i + 1) > begin_ns && size_N(wrench) > size_N(largest)) largest = wrench;
    }
  }
  return largest;
}

void TrackSource::set_track(TrackFile track) {
  replay_.set_track(std::move(track));
  frames_ = 0;
}

void TrackSource::play(GstBuffer* buffer, GstClockTime default_duration, const GstSegment& segment,
                       int64_t running_ns, FrameReport& report) {
  limits_.set_touching(false);
  const int64_t shown_ns = times_.at_sink_ns(running_ns);
  const auto place =
      place_of(buffer, default_duration, segment, shown_ns, times_.rate_multiplier());
  if (!place) return;
  ++frames_;
  replay_.play(*place, [this](const TrackBlock& block) { samples_.add(block); });
  report.frame.wrench = replay_.largest(*place);
  const bool silent = size_N(report.frame.wrench) < kFeltForce_N;
  const std::optional<LoopSnapshot> loop = output_.snapshot();
  const bool weak = !silent && loop && loop->last.max_force_N < kFeltForce_N;
  report.limit = silent ? NoForceReason::kSilentTrack
                 : weak ? NoForceReason::kTooWeak
                        : NoForceReason::kNone;
  limits_.add(shown_ns, weak ? Wrench() : report.frame.wrench, report.limit);
}

bool TrackSource::take(const PassingFrame& frame, int64_t running_ns, FrameReport& report) {
  play(frame.video.buffer, nominal_duration(frame.video.info), frame.segment, running_ns, report);
  if (frame.touch.kind != TouchKind::kOff) report.touch_problem = TouchProblem::kTrack;
  touch_.end(times_.at_sink_ns(running_ns));
  return true;
}

void TrackSource::pass_gap(GstBuffer* buffer, const GstSegment& segment, int64_t running_ns) {
  FrameReport unread;
  play(buffer, 0, segment, running_ns, unread);
}

}  // namespace spidar
