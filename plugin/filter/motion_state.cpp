// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/motion_state.h"

#include <optional>

#include "plugin/frame/frame_fields.h"
#include "plugin/timing/frame_pacer.h"

namespace spidar::filter {
namespace {

bool has_time(GstBuffer* buffer, const GstSegment& segment) {
  return segment.format == GST_FORMAT_TIME && GST_CLOCK_TIME_IS_VALID(GST_BUFFER_PTS(buffer));
}

bool is_in_time(const FrameStamp& stamp) {
  return is_time(static_cast<GstClockTime>(stamp.running_ns));
}

}  // namespace

MotionState::MotionState(GstElement* element)
    : output(element,
             [this] {
               schedule.forward_waiting();
               track_samples.forward_waiting();
             }),
      choice(element),
      display(element, output, no_force, choice, unread_messages),
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
  const std::string trace_error =
      output.open(properties.device, properties.profile, properties.analyzer.controller.max_force_N,
                  properties.haptic_trace);
  HapticLoop* const loop = &output.session()->loop();
  schedule.connect(loop);
  track_samples.connect(loop);
  reliefs.connect(loop, output.profile(), GripPointer(output.profile().geometry).half_size_m());
  no_force.set_can_touch(output.session()->grip().abilities().can_touch());
  return trace_error;
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

void MotionState::clear() {
  schedule.clear();
  track_samples.clear();
  reliefs.clear();
}

void MotionState::skip(GstClockTime duration) {
  const std::lock_guard<std::mutex> lock(skip_mutex_);
  schedule.skip(duration);
  output.follower().set_skipped(schedule.skipped_ns());
}

void MotionState::change_rate(double multiplier, GstClockTime running_time, GstClockTime upstream) {
  // Drops everything from a track; the next frame adds it again at the new rate. This comes first,
  // because what the schedule forwards after it must stay.
  track_samples.clear();
  schedule.change_rate(multiplier, running_time, upstream);
}

void MotionState::reset() {
  begin_epoch();
  live.reset();
  {
    const std::lock_guard<std::mutex> lock(skip_mutex_);
    schedule.reset();
    output.follower().set_skipped(0);
  }
  no_force.reset();
}

void MotionState::describe(FieldSink& to) const {
  stats.describe(to);
  const std::optional<LoopSnapshot> loop = output.snapshot();
  no_force_fields(no_force.of_film(loop), no_force.of_device(loop), to);
  to("track", "", track.path().c_str(),
     "file of the haptic track that is played; empty if there is none");
  to("track-frames", "", track.frames(), "frames that were shown while a haptic track plays");
  reliefs.describe(to);
  output.describe(to);
  if (loop) {
    to("refused-wrenches", "", schedule.refused() + loop->counters.refused_wrenches,
       "wrenches that were not rendered, because too many were waiting or their times did not "
       "increase");
  }
}

const FrameReport& MotionState::process(const GstVideoFrame& frame, const GstSegment& segment) {
  report_ = report_of(frame, segment);
  if (!report_.has_wrench()) return report_;
  warnings.check_trace(trace.write(report_));
  if (report_.analyzed) stats.add(report_);
  return report_;
}

FrameReport MotionState::report_of(const GstVideoFrame& frame, const GstSegment& segment) {
  FrameReport report;
  const bool timed = has_time(frame.buffer, segment);
  const std::optional<FrameStamp> stamp =
      timed ? stamp_of(frame.buffer, nominal_duration(frame.info), segment, epoch_) : std::nullopt;
  if (timed && !stamp) {
    report.fault = FrameReport::Fault::kNotShown;
    return report;
  }
  if (!timed || !is_in_time(*stamp)) {  // it cannot be rendered in time
    report.fault = FrameReport::Fault::kNoTimestamp;
    live.begin_run();
    return report;
  }
  report.turn = orientation.turn();
  report.visible = visible_part(frame);
  const PassingFrame passing{frame, segment, frame_settings, *stamp};
  if (track.has_track()) {
    track.process(passing, report);
  } else {
    live.process(passing, report);
  }
  // The analysis has a time of its own, in which frames are as far apart as in the film.
  report.frame.stamp = *stamp;
  if (report.has_wrench()) report.device_no_force = no_force.of_device(output.snapshot());
  return report;
}

void MotionState::pass_gap(GstBuffer* buffer, const GstSegment& segment) {
  const std::optional<FrameStamp> stamp =
      has_time(buffer, segment) ? stamp_of(buffer, 0, segment, epoch_) : std::nullopt;
  if (!stamp || !is_in_time(*stamp)) return live.begin_run();
  if (track.has_track()) {
    track.pass_gap(*stamp);
  } else {
    live.pass_gap(*stamp, orientation.turn());
  }
}

}  // namespace spidar::filter
