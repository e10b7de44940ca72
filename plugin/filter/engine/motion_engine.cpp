// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/engine/motion_engine.h"

#include <utility>

#include "plugin/frame/motion_message.h"
#include "plugin/timing/frame_pacer.h"

namespace spidar {

std::string MotionEngine::open(const MotionProperties& properties) {
  live_.configure(properties.analyzer);
  if (properties.device == "none") {
    if (properties.haptic_trace.empty()) return {};
    return "haptic-trace=" + properties.haptic_trace +
           " is not written: it is of a device, and device=none opens none. trace= writes what "
           "each frame asks for";
  }
  const std::string trace_problem =
      output_.open(properties.device, properties.profile, properties.haptic_trace);
  if (!output_.session()) return trace_problem;
  HapticLoop* const loop = &output_.session()->loop();
  schedule_.connect(loop);
  track_samples_.connect(loop);
  touch_.connect();
  no_force_watch_.set_can_touch(output_.session()->grip().abilities().can_touch());
  return trace_problem;
}

void MotionEngine::close() {
  schedule_.connect(nullptr);
  track_samples_.connect(nullptr);
  output_.close();
  touch_.disconnect();
}

std::string MotionEngine::start(const std::string& trace_path) {
  stats_.reset();
  restart_timing();
  return trace_path.empty() ? std::string() : trace_.open(trace_path);
}

LineWriter::Status MotionEngine::stop() {
  flush();
  return trace_.close();
}

void MotionEngine::set_muted(bool muted) {
  schedule_.set_muted(muted);
  track_samples_.set_muted(muted);
  no_force_watch_.set_muted(muted);
  touch_.set_muted(muted);
}

void MotionEngine::flush() {
  schedule_.forget();
  track_samples_.forget();
  touch_.forget();
}

void MotionEngine::skip(GstClockTime duration) {
  const std::lock_guard<std::mutex> lock(skip_mutex_);
  schedule_.skip(duration);
  output_.set_skipped(schedule_.skipped_ns());
}

void MotionEngine::begin_segment() {
  schedule_.begin_segment();
  track_.restart();
  live_.begin_segment();
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
  const std::optional<LoopSnapshot> loop = output_.snapshot();
  describe_limits(no_force_watch_.of_film(loop), no_force_watch_.of_device(loop), structure);
  gst_structure_set(structure, "track", G_TYPE_STRING, track_.path().c_str(), "track-frames",
                    G_TYPE_UINT64, track_.frames(), nullptr);
  touch_.describe(structure);
  output_.describe(structure);
  if (loop) {
    gst_structure_set(structure, "refused-wrenches", G_TYPE_UINT64,
                      schedule_.refused() + loop->counters.refused_wrenches, nullptr);
  }
  return structure;
}

NoForceReason MotionEngine::no_force_reason() const {
  return no_force_watch_.first(output_.snapshot());
}

void MotionEngine::change_rate(double multiplier, GstClockTime running_time,
                               GstClockTime upstream) {
  // Drops everything from a track; the next frame adds it again at the new rate. This comes first,
  // because what the schedule forwards after it must stay.
  track_samples_.forget();
  schedule_.change_rate(multiplier, running_time, upstream);
}

void MotionEngine::restart_timing() {
  live_.restart_timing();
  {
    const std::lock_guard<std::mutex> lock(skip_mutex_);
    schedule_.restart();
    track_.restart();
    output_.set_skipped(0);
  }
  no_force_watch_.forget();
}

void MotionEngine::set_track(std::shared_ptr<ReadAhead> track, const std::string& path) {
  track_.set_track(std::move(track), path);
  source_ = track_.has_track() ? static_cast<WrenchSource*>(&track_) : &live_;
}

/// Nothing when it cannot be felt in time, for the report's problem.
std::optional<MotionEngine::FrameTimes> MotionEngine::times_of(const PassingFrame& frame) {
  const GstClockTime pts = GST_BUFFER_PTS(frame.video.buffer);
  const bool has_time = frame.segment.format == GST_FORMAT_TIME && GST_CLOCK_TIME_IS_VALID(pts);
  const GstClockTime shown = has_time ? shown_at(frame.video, frame.segment) : GST_CLOCK_TIME_NONE;
  if (has_time && !GST_CLOCK_TIME_IS_VALID(shown)) {
    report_.problem = FrameProblem::kNotShown;
    return std::nullopt;
  }
  if (!is_time(shown)) {
    restart();
    report_.problem = FrameProblem::kNoTimestamp;
    return std::nullopt;
  }
  const GstClockTime stream = gst_segment_to_stream_time(&frame.segment, GST_FORMAT_TIME, pts);
  return FrameTimes{static_cast<int64_t>(shown), static_cast<int64_t>(stream)};
}

FrameReport& MotionEngine::process(const PassingFrame& frame) {
  report_.begin();
  const std::optional<FrameTimes> times = times_of(frame);
  if (!times) return report_;
  const bool is_taken = source_->take(frame, times->running_ns, report_);
  // The analysis has a time of its own, in which frames are as far apart as in the film.
  report_.frame.running_ns = times->running_ns;
  report_.frame.stream_ns = times->stream_ns;
  if (!is_taken) return report_;
  report_.device_limit = no_force_watch_.of_device(output_.snapshot());
  report_.trace_error = trace_.write(report_);
  if (report_.analyzed) stats_.add(report_.frame, report_.took_ns);
  return report_;
}

void MotionEngine::pass_gap(GstBuffer* buffer, const GstSegment& segment) {
  const GstClockTime running_time = running_time_of(segment, GST_BUFFER_PTS(buffer));
  if (is_time(running_time)) {
    source_->pass_gap(buffer, segment, static_cast<int64_t>(running_time));
  } else {
    restart();
  }
}

}  // namespace spidar
