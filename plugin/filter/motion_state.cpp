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
    : feed(element),
      track(element, feed),
      choice(element),
      display(element, feed.output, feed.no_force, choice, unread),
      steps(element, [this](GstClockTime skipped) { feed.skip(skipped); }),
      warnings(element) {}

void MotionState::reset() {
  begin_epoch();
  film.reset();
  feed.reset();
}

void MotionState::describe(FieldSink& to) const {
  stats.describe(to);
  const std::optional<LoopSnapshot> loop = feed.output.snapshot();
  no_force_fields(feed.no_force.of_film(loop), feed.no_force.of_device(loop), to);
  to("track", "", track.path().c_str(),
     "file of the haptic track that is played; empty if there is none");
  to("track-frames", "", track.frames(), "frames that were shown while a haptic track plays");
  feed.reliefs.describe(to);
  feed.output.describe(to);
  if (loop) {
    to("refused-wrenches", "", feed.schedule.refused() + loop->counters.refused_wrenches,
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
  if (!timed || !is_in_time(*stamp)) {  // such a frame cannot be rendered in time
    report.fault = FrameReport::Fault::kNoTimestamp;
    film.begin_run();
    return report;
  }
  report.stamp = *stamp;
  report.turn = orientation.turn();
  report.visible = visible_part(frame);
  if (track.has_track()) {
    track.process(report);
  } else {
    film.process({frame, segment, frame_settings}, report);
  }
  if (report.has_wrench()) report.device_no_force = feed.no_force.of_device(feed.output.snapshot());
  return report;
}

void MotionState::pass_gap(GstBuffer* buffer, const GstSegment& segment) {
  const std::optional<FrameStamp> stamp =
      has_time(buffer, segment) ? stamp_of(buffer, 0, segment, epoch_) : std::nullopt;
  if (!stamp || !is_in_time(*stamp)) return film.begin_run();
  if (track.has_track()) {
    track.pass_gap(*stamp);
  } else {
    film.pass_gap(*stamp, orientation.turn());
  }
}

}  // namespace spidar::filter
