// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/motion_state.h"

#include <optional>

#include "plugin/frame/motion_message.h"
#include "plugin/timing/frame_pacer.h"

namespace spidar {
namespace {

/// When the sink shows a frame. Nothing when it cannot be rendered in time, for `problem`.
std::optional<int64_t> time_of(const GstVideoFrame& frame, const GstSegment& segment,
                               FrameProblem& problem) {
  const bool has_time =
      segment.format == GST_FORMAT_TIME && GST_CLOCK_TIME_IS_VALID(GST_BUFFER_PTS(frame.buffer));
  const GstClockTime shown = has_time ? shown_at(frame, segment) : GST_CLOCK_TIME_NONE;
  if (is_time(shown)) return static_cast<int64_t>(shown);
  const bool is_cut = has_time && !GST_CLOCK_TIME_IS_VALID(shown);
  problem = is_cut ? FrameProblem::kNotShown : FrameProblem::kNoTimestamp;
  return std::nullopt;
}

}  // namespace

MotionState::MotionState(GstElement* element)
    : output(element,
             [this] {
               schedule.forward_waiting();
               track_samples.forward_waiting();
             }),
      choice(element),
      display(element, output, no_force, choice),
      steps(element, [this](GstClockTime skipped) { skip(skipped); }),
      felt(element),
      warnings(element) {}

std::string MotionState::open(const MotionProperties& properties) {
  live.configure(properties.analyzer);
  if (properties.device == "none") {
    if (properties.haptic_trace.empty()) return {};
    return "haptic-trace=" + properties.haptic_trace +
           " is not written: it is of a device, and device=none opens none. trace= writes what "
           "each frame asks for";
  }
  const std::string trace_problem =
      output.open(properties.device, properties.profile, properties.haptic_trace);
  HapticLoop* const loop = &output.session()->loop();
  schedule.connect(loop);
  track_samples.connect(loop);
  reliefs.connect(loop, output.profile(), GripPointer(output.profile().geometry).half_size_m());
  no_force.set_can_touch(output.session()->grip().abilities().can_touch());
  return trace_problem;
}

void MotionState::close() {
  schedule.connect(nullptr);
  track_samples.connect(nullptr);
  output.close();
  reliefs.disconnect();
}

void MotionState::set_muted(bool muted) {
  schedule.set_muted(muted);
  track_samples.set_muted(muted);
  no_force.set_muted(muted);
  reliefs.set_muted(muted);
}

void MotionState::flush() {
  schedule.forget();
  track_samples.forget();
  reliefs.forget();
}

void MotionState::skip(GstClockTime duration) {
  const std::lock_guard<std::mutex> lock(skip_mutex);
  schedule.skip(duration);
  output.follower().set_skipped(schedule.skipped_ns());
}

void MotionState::change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream) {
  // Drops everything from a track; the next frame adds it again at the new rate. This comes first,
  // because what the schedule forwards after it must stay.
  track_samples.forget();
  schedule.change_rate(multiplier, running_time, upstream);
}

void MotionState::restart_timing() {
  live.restart_timing();
  {
    const std::lock_guard<std::mutex> lock(skip_mutex);
    schedule.restart();
    track.restart();
    output.follower().set_skipped(0);
  }
  no_force.forget();
}

GstStructure* MotionState::describe() const {
  GstStructure* structure = gst_structure_new_empty("spidar-motion-stats");
  stats.describe(structure);
  const std::optional<LoopSnapshot> loop = output.snapshot();
  describe_no_force(no_force.of_film(loop), no_force.of_device(loop), structure);
  gst_structure_set(structure, "track", G_TYPE_STRING, track.path().c_str(), "track-frames",
                    G_TYPE_UINT64, track.frames(), nullptr);
  reliefs.describe(structure);
  output.describe(structure);
  if (loop) {
    gst_structure_set(structure, "refused-wrenches", G_TYPE_UINT64,
                      schedule.refused() + loop->counters.refused_wrenches, nullptr);
  }
  return structure;
}

void MotionState::process(const GstVideoFrame& frame, const GstSegment& segment) {
  report.begin();
  const std::optional<int64_t> running_ns = time_of(frame, segment, report.problem);
  if (!running_ns) {
    if (report.problem == FrameProblem::kNoTimestamp) live.restart();
    return;
  }
  report.turn = orientation.turn();
  report.visible = visible_part(frame);
  report.motion = frame_settings.analyzer.motion;
  report.controller = frame_settings.analyzer.controller;
  const PassingFrame passing{frame, segment, frame_settings, *running_ns};
  if (track.has_track()) {
    track.take(passing, report);
  } else {
    live.take(passing, report);
  }
  // The analysis has a time of its own, in which frames are as far apart as in the film.
  report.frame.running_ns = *running_ns;
  report.frame.stream_ns = static_cast<int64_t>(
      gst_segment_to_stream_time(&segment, GST_FORMAT_TIME, GST_BUFFER_PTS(frame.buffer)));
  if (!report.has_wrench()) return;
  report.device_no_force = no_force.of_device(output.snapshot());
  report.trace_error = trace.write(report);
  if (report.analyzed) stats.add(report.frame, report.took_ns);
}

void MotionState::pass_gap(GstBuffer* buffer, const GstSegment& segment) {
  const GstClockTime running_time = running_time_of(segment, GST_BUFFER_PTS(buffer));
  if (!is_time(running_time)) return live.restart();
  const auto running_ns = static_cast<int64_t>(running_time);
  if (track.has_track()) {
    track.pass_gap(buffer, segment, running_ns);
  } else {
    live.pass_gap(running_ns, orientation.turn());
  }
}

}  // namespace spidar
