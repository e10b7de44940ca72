// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/engine/motion_engine.h"

#include <algorithm>
#include <utility>

namespace spidar {
namespace {

/// With a share of 1 the result is the same bit for bit.
Wrench scaled(const Wrench& wrench, double share) {
  return {share * wrench.force_N, share * wrench.torque_Nm};
}

}  // namespace

std::string MotionEngine::open(const MotionProperties& properties) {
  analyzer_.configure(properties.analyzer);
  if (properties.device == "none") return {};
  const std::string trace_problem =
      output_.open(properties.device, properties.used_profile(), properties.haptic_trace);
  grip_pointer_ = GripPointer(output_.profile().geometry);
  schedule_.connect(&output_.session()->loop());
  player_.connect(&output_.session()->loop());
  reliefs_.connect(&output_.session()->loop(), output_.profile(), grip_pointer_.half_size_m());
  return trace_problem;
}

void MotionEngine::close() {
  schedule_.connect(nullptr);
  player_.connect(nullptr);
  output_.close();
  reliefs_.disconnect();  // releases what the loop has been reading
}

std::string MotionEngine::start(const std::string& trace_path) {
  stats_.reset();
  restart_timing();
  return trace_path.empty() ? std::string() : trace_.open(trace_path);
}

bool MotionEngine::stop() {
  flush();
  return trace_.close();
}

void MotionEngine::set_muted(bool muted) {
  schedule_.set_muted(muted);
  limit_watch_.set_muted(muted);
  player_.set_muted(muted);
  reliefs_.set_muted(muted);
}

void MotionEngine::flush() {
  schedule_.forget();
  player_.forget();
  reliefs_.forget();
}

void MotionEngine::skip(GstClockTime duration) {
  const std::lock_guard<std::mutex> lock(skip_mutex_);
  schedule_.skip(duration);
  output_.set_skipped(schedule_.skipped_ns());
}

void MotionEngine::begin_segment() {
  schedule_.begin_segment();
  player_.restart();
  pacer_.begin_segment();
}

void MotionEngine::begin_stream() {
  // What is scheduled stays: without a flush, its frames still wait for the screen.
  restart();
  orientation_.begin_stream();
  turn_ = orientation_.turn();
}

void MotionEngine::take_tags(const GstTagList* tags) {
  orientation_.take(tags);
  turn_ = orientation_.turn();
}

GstStructure* MotionEngine::stats() const {
  GstStructure* structure = gst_structure_new_empty("spidar-motion-stats");
  stats_.describe(structure);
  describe_limit(no_force_reason(), structure);
  gst_structure_set(structure, "track-frames", G_TYPE_UINT64, player_.frames(), nullptr);
  reliefs_.describe(structure);
  output_.describe(structure);
  if (const std::optional<LoopSnapshot> loop = output_.snapshot()) {
    gst_structure_set(structure, "refused-wrenches", G_TYPE_UINT64,
                      schedule_.refused() + loop->counters.refused_wrenches, nullptr);
  }
  return structure;
}

NoForceReason MotionEngine::no_force_reason() const {
  return limit_watch_.limit(output_.snapshot(), true);
}

std::optional<Eigen::Vector2d> MotionEngine::grip_place() const {
  const std::optional<LoopSnapshot> loop = output_.snapshot();
  if (!loop || loop->last.device != DeviceState::kRunning) return std::nullopt;
  return grip_pointer_.place(loop->last.pose.position_m);
}

void MotionEngine::change_rate(double multiplier, GstClockTime running_time,
                               GstClockTime upstream) {
  // Drops everything from a track; the next frame adds it again at the new rate. This comes first,
  // because what the schedule hands on after it must stay.
  player_.forget();
  schedule_.change_rate(multiplier, running_time, upstream);
}

void MotionEngine::restart() {
  analyzer_.restart();
}

void MotionEngine::restart_timing() {
  restart();
  {
    const std::lock_guard<std::mutex> lock(skip_mutex_);
    schedule_.restart();
    player_.restart();
    output_.set_skipped(0);
  }
  limit_watch_.forget();
  pacer_.restart();
  gap_ns_.reset();
}

void MotionEngine::run_out(GstClockTime running_time) {
  restart();
  if (!is_time(running_time)) return;  // scheduled wrenches expire without help
  schedule_.add({static_cast<int64_t>(running_time), 0, Wrench()});
}

void MotionEngine::begin_gap(GstClockTime running_time) {
  if (!is_time(running_time) || !pacer_.has_frame()) {
    run_out(running_time);
  } else if (!gap_ns_) {  // while no frame comes, the force ends without help
    gap_ns_ = static_cast<int64_t>(running_time);
  }
}

void MotionEngine::end_gap(int64_t running_ns) {
  constexpr int64_t kLate_ns = 10'000'000;
  if (!gap_ns_ || running_ns < *gap_ns_) return;
  // A frame that comes when the next one was due shows that there was no gap.
  if (running_ns > pacer_.next_ns() + kLate_ns) run_out(static_cast<GstClockTime>(*gap_ns_));
  gap_ns_.reset();
}

void MotionEngine::pass_gap(GstClockTime running_time) {
  if (!is_time(running_time)) {
    restart();
    return;
  }
  const int64_t running_ns = static_cast<int64_t>(running_time);
  const FrameTime time = pacer_.at(running_ns, schedule_.rate_multiplier());
  // videorate makes such a gap of a frame that is shown again.
  const std::optional<FrameAnalysis> analysis =
      time.since_ns > 0 ? analyzer_.repeat(time.paced_ns) : std::nullopt;
  if (analysis) {
    schedule_.add({running_ns, WrenchTimeline::hold_after(time.since_ns),
                   turn_.to_shown(scaled(analysis->wrench, motion_share_)), analysis->repeated});
    limit_watch_.repeat(schedule_.at_sink_ns(running_ns), analysis->wrench);
  } else {
    run_out(running_time);
    limit_watch_.repeat(schedule_.at_sink_ns(running_ns), Wrench());
  }
  pacer_.pass(time);
}

void MotionEngine::end_of_stream() {
  if (!pacer_.has_frame()) return;
  run_out(static_cast<GstClockTime>(pacer_.next_ns()));
  reliefs_.end(schedule_.at_sink_ns(pacer_.next_ns()));
}

void MotionEngine::set_track(std::optional<TrackFile> track) {
  player_.set_track(std::move(track).value_or(TrackFile{}));
}

void MotionEngine::touch_frame(GstBuffer* buffer, const ImageView& luma,
                               const TouchProperties& touch, int64_t running_ns,
                               FrameReport& report) {
  const Eigen::Vector2d middle(0.5, 0.5);
  const Eigen::Vector2d finger = turn_.place_coded(grip_place().value_or(middle));
  reliefs_.set_turn(turn_);
  const bool found =
      reliefs_.add(buffer, luma, report.analysis, schedule_.at_sink_ns(running_ns), touch, finger);
  if (touch.kind == TouchKind::kOff) return;
  if (output_.session() == nullptr) {
    report.touch_problem = TouchProblem::kNoDevice;
    return;
  }
  report.touch.on = true;
  report.touch.map = {grip_pointer_, turn_};
  report.touch.stiffness_N_m = contact_settings(touch, output_.profile()).stiffness_N_m;
  report.touch.motion_share = touch.motion_share;
  report.touch.relief = reliefs_.take_copy();
  if (const std::optional<LoopSnapshot> loop = output_.snapshot()) {
    report.touch_mark = touch_mark(report.touch, loop->last);
  }
  report.stiffness_N_m = most_stiffness_N_m(output_.profile());
  if (touch.stiffness_N_m > report.stiffness_N_m) {
    report.touch_problem =
        output_.profile().drive_lag_known ? TouchProblem::kTooStiff : TouchProblem::kLagUnknown;
  }
  if (!found) report.touch_problem = TouchProblem::kNoDepth;
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
    const auto place = place_of(frame.buffer, nominal_duration(frame.info), segment,
                                schedule_.at_sink_ns(running_ns), schedule_.rate_multiplier());
    if (place) player_.play(*place);
    if (touch.kind != TouchKind::kOff) report.touch_problem = TouchProblem::kTrack;
    limit_watch_.set_touching(false);
    reliefs_.end(schedule_.at_sink_ns(running_ns));
    return report;
  }
  end_gap(running_ns);
  const FramePacer::Order order = pacer_.order(running_ns, frame, segment);
  if (order == FramePacer::Order::kTooSoon) {
    report.problem = FrameProblem::kSameTimestamp;
    return report;
  }
  if (order == FramePacer::Order::kFalling) report.problem = FrameProblem::kFallingTimestamp;
  if (order != FramePacer::Order::kNext) restart();

  if (!holds_picture(frame)) {
    restart();
    report.problem = FrameProblem::kTooSmall;
    return report;
  }
  const ImageView luma = luma_.view(frame);
  const std::optional<DepthLayout> packed = touch.packed();
  const ImageView picture = packed ? picture_half(luma, *packed) : luma;
  if (!luma.data || std::min(picture.width, picture.height) < FrameLuma::kSmallestSide) {
    restart();
    report.problem = luma.data ? FrameProblem::kSmallHalf : FrameProblem::kNotShown;
    return report;
  }
  analyzer_.configure(settings);
  const int64_t begin_ns = HapticSession::monotonic_now_ns();
  const FrameTime time = pacer_.at(running_ns, schedule_.rate_multiplier());
  report.analysis = analyzer_.analyze(picture, time.paced_ns);
  report.analyzed = true;
  // The picture is the left or the upper half.
  report.part = visible_part(frame);
  report.part.width = picture.width;
  report.part.height = picture.height;
  report.took_ns = HapticSession::monotonic_now_ns() - begin_ns;

  const bool moved = report.analysis.interval_ns > 0 || report.analysis.repeated;
  pacer_.take(time, moved);
  limit_watch_.add(schedule_.at_sink_ns(running_ns), report.analysis, settings.motion);
  limit_watch_.set_touching(touch.kind != TouchKind::kOff);
  // This share of the film's motion is felt, reported and shown in addition to touch.
  motion_share_ = touch.kind == TouchKind::kOff ? 1 : touch.motion_share;
  report.analysis.wrench = turn_.to_shown(scaled(report.analysis.wrench, motion_share_));
  report.turn = turn_;
  if (!time.in_place) {
    touch_frame(frame.buffer, luma, touch, running_ns, report);
    schedule_.add({running_ns, WrenchTimeline::hold_after(moved ? time.since_ns : 0),
                   report.analysis.wrench, report.analysis.repeated});
  }
  report.limit = limit_watch_.limit(output_.snapshot(), false);
  if (trace_.is_open()) {
    report.trace_failed = !trace_.write(running_ns, static_cast<int64_t>(report.stream_time),
                                        report.analysis, report.limit);
  }
  stats_.add(report.analysis, report.took_ns);
  return report;
}

}  // namespace spidar
