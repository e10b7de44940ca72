// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/engine/track_source.h"

#include <optional>
#include <utility>

#include "core/force/felt_force.h"
#include "plugin/timing/frame_pacer.h"

namespace spidar {
namespace {

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

bool TrackSource::take(const PassingFrame& frame, FrameReport& report) {
  const int64_t running_ns = report.frame.running_ns;
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
