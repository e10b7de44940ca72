// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/engine/film_renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/force/wrench_timeline.h"
#include "spidar/realtime/monotonic.h"

namespace spidar::filter {
namespace {

/// Makes the relief of an analysed frame, whose brightness is `luma` and which the sink shows at
/// `shown_ns`. Fills in the report's fields on touching. Streaming thread.
void touch_frame(const PassingFrame& passing, const ImageView& luma, int64_t shown_ns,
                 const HapticOutput& output, ReliefStream& reliefs, FrameReport& report) {
  const TouchProperties& touch = passing.settings.touch;
  const HapticSession* const session = output.session();
  const bool on = touch.kind != TouchProperties::Kind::kOff;
  if (on && session && !session->grip().abilities().can_touch()) return;
  const Eigen::Vector2d middle(0.5, 0.5);
  reliefs.set_turn(report.turn);
  reliefs.set_levels(luma_levels(passing.video.info));
  reliefs.add(luma, report.frame, shown_ns, touch,
              report.turn.stored_position(grip_position(output).value_or(middle)),
              passing.settings.display.debug_window ? &report.touch.shading : nullptr);
  if (!on || !session) return;
  report.touch.on = true;
  report.touch.pointer = GripPointer(output.profile().geometry, report.turn);
  report.touch.stiffness_N_m = contact_settings(touch, output.profile()).stiffness_N_m;
  report.touch.motion_fraction = touch.motion_fraction;
}

}  // namespace

std::optional<Eigen::Vector2d> grip_position(const HapticOutput& output) {
  const std::optional<LoopSnapshot> loop = output.snapshot();
  if (!loop || loop->last.device != DeviceState::kRunning) return std::nullopt;
  return GripPointer(output.profile().geometry).position(loop->last.pose.position_m);
}

void FilmRenderer::reset() {
  begin_run();
  pacer_.reset();
  gap_ns_.reset();
}

void FilmRenderer::run_out(GstClockTime running_time) {
  begin_run();
  if (!is_time(running_time)) return;  // scheduled wrenches expire by themselves
  feed_.schedule.add({static_cast<int64_t>(running_time), 0, Wrench()});
}

void FilmRenderer::begin_gap(GstClockTime running_time) {
  if (!is_time(running_time) || !pacer_.has_frame()) {
    run_out(running_time);
  } else if (!gap_ns_) {  // without frames, the force expires
    gap_ns_ = static_cast<int64_t>(running_time);
  }
}

void FilmRenderer::end_gap(int64_t running_ns) {
  constexpr int64_t kLate_ns = 10'000'000;
  if (!gap_ns_ || running_ns < *gap_ns_) return;
  // A frame at the time when the next one was due shows that there was no gap.
  if (running_ns > pacer_.next_ns() + kLate_ns) run_out(static_cast<GstClockTime>(*gap_ns_));
  gap_ns_.reset();
}

void FilmRenderer::end_of_stream() {
  if (!pacer_.has_frame()) return;
  run_out(static_cast<GstClockTime>(pacer_.next_ns()));
  feed_.reliefs.end(feed_.schedule.at_sink_ns(pacer_.next_ns()));
}

/// Begins a new run if the frame belongs to another epoch.
void FilmRenderer::follow(const FrameStamp& stamp) {
  if (std::exchange(epoch_, stamp.epoch) != stamp.epoch) begin_run();
}

/// The wrench of an analysed frame as it is rendered: turned, and weakened while it is touched.
Wrench FilmRenderer::shown_wrench(const Frame& frame, const Orientation& turn) const {
  const Wrench shown = turn.to_displayed(frame.wrench);
  return {motion_fraction_ * shown.force_N, motion_fraction_ * shown.torque_Nm};
}

/// Schedules `shown` instead of the frame's own wrench. A motion belongs to the moment halfway
/// between its two pictures; while a picture repeats, halfway between its first frame and this one.
void FilmRenderer::schedule(const Frame& frame, const PacedTime& time, bool moved,
                            const Wrench& shown) {
  if (!frame.is_continuation()) picture_ns_ = time.running_ns;
  const double apart_ns =
      frame.is_continuation()
          ? static_cast<double>(time.running_ns - picture_ns_)
          : feed_.schedule.rate_multiplier() * static_cast<double>(frame.interval_ns);
  feed_.schedule.add({time.running_ns, WrenchTimeline::hold_after(moved ? time.since_ns : 0), shown,
                      frame.is_continuation(), std::llround(apart_ns) / 2});
}

void FilmRenderer::pass_gap(const FrameStamp& stamp, const Orientation& turn) {
  follow(stamp);
  const int64_t running_ns = stamp.running_ns;
  const PacedTime time = pacer_.at(running_ns, feed_.schedule.rate_multiplier());
  // videorate marks a repeated frame as such a gap.
  const Frame* const frame = time.since_ns > 0 ? analyzer_.repeat(time.paced_ns) : nullptr;
  const Wrench wrench = frame ? shown_wrench(*frame, turn) : Wrench();
  if (frame) {
    schedule(*frame, time, true, wrench);
  } else {
    run_out(static_cast<GstClockTime>(running_ns));
  }
  feed_.no_force.add(feed_.schedule.at_sink_ns(running_ns), wrench, NoForceReason::kRepeatedFrames);
  pacer_.advance(time);
}

/// Returns false if the frame comes too soon after the previous one. Fills in timestamp faults.
bool FilmRenderer::follows(const PassingFrame& frame, FrameReport& report) {
  follow(report.stamp);
  end_gap(report.stamp.running_ns);
  const FramePacer::Order order = pacer_.order(report.stamp.running_ns, frame.video, frame.segment);
  if (order == FramePacer::Order::kTooSoon) {
    report.fault = FrameReport::Fault::kSameTimestamp;
    return false;
  }
  if (order == FramePacer::Order::kFalling) report.fault = FrameReport::Fault::kFallingTimestamp;
  if (order != FramePacer::Order::kNext) begin_run();
  return true;
}

/// Finds the picture of a frame and analyses it. Returns false when the frame has no picture.
bool FilmRenderer::analyze(const PassingFrame& frame, const ImageView& luma, int64_t paced_ns,
                           FrameReport& report) {
  const std::optional<touch::DepthLayout> packed = frame.settings.touch.packed();
  const ImageView picture = packed ? touch::picture_half(luma, *packed) : luma;
  const double aspect = pixel_aspect(frame.video.info);
  const auto has_short_side = [&](int width, int height) {
    const int square = SquarePixelResampler::width_of(width, aspect);
    return std::min({width, square, height}) < FrameLuma::kSmallestSide;
  };
  const auto is_small = [&](const ImageView& part) {
    return !part.data || has_short_side(part.width, part.height);
  };
  if (is_small(picture)) {
    begin_run();
    const PicturePart& part = report.visible;
    const bool is_cropped =
        part.width < frame.video.info.width || part.height < frame.video.info.height;
    report.fault = !is_small(luma) ? FrameReport::Fault::kSmallHalf
                   : is_cropped    ? FrameReport::Fault::kNotShown
                                   : FrameReport::Fault::kWrongSize;
    return false;
  }
  AnalyzerSettings settings = frame.settings.analyzer;
  const PicturePart area = settings.area.of_picture(picture.width, picture.height);
  if (has_short_side(area.width, area.height)) {
    begin_run();
    report.fault = FrameReport::Fault::kSmallArea;
    return false;
  }
  const int64_t begin_ns = monotonic_now_ns();
  const ImageView square = square_.view(picture, aspect);
  settings.area.part = in_square_pixels(area, picture.width, square.width);
  analyzer_.configure(settings);
  report.frame = analyzer_.analyze(square, paced_ns, std::max<int64_t>(report.stamp.stream_ns, 0),
                                   report.turn);
  report.frame.wrench = shown_wrench(report.frame, report.turn);
  report.no_force = reason_in_frame(report.frame, frame.settings.analyzer.motion);
  to_stored_pixels(report.frame, picture.width);
  // In a packed frame, the picture is the left or the upper half.
  report.visible.width = picture.width;
  report.visible.height = picture.height;
  report.took_ns = monotonic_now_ns() - begin_ns;
  return true;
}

void FilmRenderer::process(const PassingFrame& frame, FrameReport& report) {
  if (!follows(frame, report)) return;
  const bool has_size = FrameLuma::supports(frame.video.info);
  if (!has_size || !holds_picture(frame.video)) {
    begin_run();
    report.fault = has_size ? FrameReport::Fault::kTooSmall : FrameReport::Fault::kWrongSize;
    return;
  }
  const int64_t shown_ns = feed_.schedule.at_sink_ns(report.stamp.running_ns);
  const PacedTime time = pacer_.at(report.stamp.running_ns, feed_.schedule.rate_multiplier());
  const ImageView luma = luma_.view(frame.video);
  const TouchProperties& touch = frame.settings.touch;
  // This fraction of the film's motion is rendered, reported and shown in addition to touch.
  motion_fraction_ = touch.kind == TouchProperties::Kind::kOff ? 1 : touch.motion_fraction;
  report.analyzed = analyze(frame, luma, time.paced_ns, report);
  if (!report.analyzed) return;

  const bool moved = report.frame.interval_ns > 0 || report.frame.is_continuation();
  pacer_.push(time, moved);
  feed_.no_force.add(shown_ns, report.frame.wrench, report.no_force);
  feed_.no_force.set_touching(touch.kind != TouchProperties::Kind::kOff);
  if (!time.in_place) {
    touch_frame(frame, luma, shown_ns, feed_.output, feed_.reliefs, report);
    schedule(report.frame, time, moved, report.frame.wrench);
  }
}

}  // namespace spidar::filter
