// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What becomes of a frame.
#include <algorithm>
#include <utility>

#include "core/force/felt_force.h"
#include "plugin/engine/motion_engine.h"

namespace spidar {
namespace {

/// With a share of 1 the result is the same bit for bit.
Wrench scaled(const Wrench& wrench, double share) {
  return {share * wrench.force_N, share * wrench.torque_Nm};
}

/// The stream time at which a frame is first seen; 0 when it is not known, or not shown.
int64_t stream_ns_of(GstBuffer* buffer, const GstSegment& segment) {
  const GstClockTime pts = GST_BUFFER_PTS(buffer), duration = GST_BUFFER_DURATION(buffer);
  guint64 from = 0, to = 0;
  if (segment.format != GST_FORMAT_TIME || !is_time(pts) ||
      !gst_segment_clip(&segment, GST_FORMAT_TIME, pts,
                        is_time(duration) ? pts + duration : GST_CLOCK_TIME_NONE, &from, &to)) {
    return 0;
  }
  const GstClockTime stream = gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, from);
  return is_time(stream) ? static_cast<int64_t>(stream) : 0;
}

}  // namespace

void MotionEngine::pass_gap(GstBuffer* buffer, const GstSegment& segment) {
  const GstClockTime running_time =
      segment.format == GST_FORMAT_TIME
          ? gst_segment_to_running_time(&segment, GST_FORMAT_TIME, GST_BUFFER_PTS(buffer))
          : GST_CLOCK_TIME_NONE;
  if (!is_time(running_time)) {
    restart();
    return;
  }
  const int64_t running_ns = static_cast<int64_t>(running_time);
  if (player_.active()) {
    FrameReport report;
    play_track(buffer, 0, segment, running_ns, report);
    return;
  }
  const FrameTime time = pacer_.at(running_ns, schedule_.rate_multiplier());
  // videorate makes such a gap of a frame that is shown again.
  std::optional<FrameAnalysis> analysis;
  if (time.since_ns > 0) analysis = analyzer_.repeat(time.paced_ns);
  if (analysis) {
    schedule_.add({running_ns, WrenchTimeline::hold_after(time.since_ns),
                   turn_.to_shown(scaled(analysis->wrench, motion_share_)), analysis->repeated});
    limit_watch_.add(schedule_.at_sink_ns(running_ns), analysis->wrench,
                     NoForceReason::kRepeatedFrames);
  } else {
    run_out(running_time);
    limit_watch_.add(schedule_.at_sink_ns(running_ns), Wrench(), NoForceReason::kRepeatedFrames);
  }
  pacer_.pass(time);
}

/// Whether a frame follows the one before in time, and if not, why it cannot be analysed.
bool MotionEngine::follows(const GstVideoFrame& frame, const GstSegment& segment,
                           FrameReport& report) {
  const auto running_ns = static_cast<int64_t>(report.running_time);
  end_gap(running_ns);
  const FramePacer::Order order = pacer_.order(running_ns, frame, segment);
  if (order == FramePacer::Order::kTooSoon) {
    report.problem = FrameProblem::kSameTimestamp;
    return false;
  }
  if (order == FramePacer::Order::kFalling) report.problem = FrameProblem::kFallingTimestamp;
  if (order != FramePacer::Order::kNext) restart();
  return true;
}

/// Finds the picture of a frame and analyses it. False when it has none.
bool MotionEngine::analyze(const GstVideoFrame& frame, const GstSegment& segment,
                           const ImageView& luma, const AnalyzerSettings& settings,
                           const TouchProperties& touch, int64_t paced_ns, FrameReport& report) {
  const std::optional<DepthLayout> packed = touch.packed();
  const ImageView picture = packed ? picture_half(luma, *packed) : luma;
  if (!luma.data || std::min(picture.width, picture.height) < FrameLuma::kSmallestSide) {
    restart();
    report.problem = luma.data ? FrameProblem::kSmallHalf : FrameProblem::kNotShown;
    return false;
  }
  const int64_t begin_ns = HapticSession::monotonic_now_ns();
  const FilmPlace film{stream_ns_of(frame.buffer, segment), turn_};
  analyzer_.configure(settings);
  report.analysis =
      analyzer_.analyze(square_.view(picture, pixel_aspect(frame.info)), paced_ns, film);
  // The picture is the left or the upper half.
  report.part = visible_part(frame);
  report.part.width = picture.width;
  report.part.height = picture.height;
  report.took_ns = HapticSession::monotonic_now_ns() - begin_ns;
  return true;
}

/// Gives what is felt while a frame is shown, and reports the largest wrench of it.
void MotionEngine::play_track(GstBuffer* frame, GstClockTime default_duration,
                              const GstSegment& segment, int64_t running_ns, FrameReport& report) {
  limit_watch_.set_touching(false);
  const int64_t shown_ns = schedule_.at_sink_ns(running_ns);
  const auto place =
      place_of(frame, default_duration, segment, shown_ns, schedule_.rate_multiplier());
  if (!place) return;
  const Wrench largest = player_.play(*place);
  const bool silent = size_N(largest) < kFeltForce_N;
  const std::optional<LoopSnapshot> loop = output_.snapshot();
  const bool weak = !silent && loop && loop->last.max_force_N < kFeltForce_N;
  report.limit = silent ? NoForceReason::kSilentTrack
                 : weak ? NoForceReason::kTooWeak
                        : NoForceReason::kNone;
  limit_watch_.add(shown_ns, weak ? Wrench() : largest, report.limit);
  report.analysis.wrench = largest;
}

/// Why nothing is felt, and the trace.
void MotionEngine::write_row(FrameReport& report) {
  report.device_limit = limit_watch_.of_device(output_.snapshot());
  if (trace_.is_open()) report.trace_failed = !trace_.write(report);
}

FrameReport MotionEngine::process(const GstVideoFrame& frame, const GstSegment& segment,
                                  const AnalyzerSettings& settings, const TouchProperties& touch) {
  FrameReport report;
  const GstClockTime pts = GST_BUFFER_PTS(frame.buffer);
  if (segment.format != GST_FORMAT_TIME || !GST_CLOCK_TIME_IS_VALID(pts)) {
    restart();
    report.problem = FrameProblem::kNoTimestamp;
    return report;
  }
  report.running_time = shown_at(frame, segment);
  report.stream_time = gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, pts);
  if (!GST_CLOCK_TIME_IS_VALID(report.running_time)) {
    report.problem = FrameProblem::kNotShown;
    return report;
  }
  if (!is_time(report.running_time)) {
    restart();
    report.problem = FrameProblem::kNoTimestamp;
    return report;
  }
  const int64_t running_ns = static_cast<int64_t>(report.running_time);
  if (player_.active()) {
    play_track(frame.buffer, nominal_duration(frame.info), segment, running_ns, report);
    if (touch.kind != TouchKind::kOff) report.touch_problem = TouchProblem::kTrack;
    reliefs_.end(schedule_.at_sink_ns(running_ns));
    write_row(report);
    return report;
  }
  if (!follows(frame, segment, report)) return report;
  if (!holds_picture(frame)) {
    restart();
    report.problem = FrameProblem::kTooSmall;
    return report;
  }
  const FrameTime time = pacer_.at(running_ns, schedule_.rate_multiplier());
  const ImageView luma = luma_.view(frame);
  report.analyzed = analyze(frame, segment, luma, settings, touch, time.paced_ns, report);
  if (!report.analyzed) return report;

  const bool moved = report.analysis.interval_ns > 0 || report.analysis.repeated;
  pacer_.take(time, moved);
  report.limit = limit_of(report.analysis, settings.motion);
  limit_watch_.add(schedule_.at_sink_ns(running_ns), report.analysis.wrench, report.limit);
  stored_.convert(report.analysis, report.part.width);
  limit_watch_.set_touching(touch.kind != TouchKind::kOff);
  // This share of the film's motion is felt, reported and shown in addition to touch.
  motion_share_ = touch.kind == TouchKind::kOff ? 1 : touch.motion_share;
  report.analysis.wrench = turn_.to_shown(scaled(report.analysis.wrench, motion_share_));
  report.turn = turn_;
  if (!time.in_place) {
    reliefs_.set_levels(luma_levels(frame.info));
    if (luma.data) touch_frame(luma, touch, running_ns, report);
    schedule_.add({running_ns, WrenchTimeline::hold_after(moved ? time.since_ns : 0),
                   report.analysis.wrench, report.analysis.repeated});
  }
  write_row(report);
  stats_.add(report.analysis, report.took_ns);
  return report;
}

}  // namespace spidar
