// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/engine/motion_engine.h"

#include <algorithm>
#include <utility>

#include "spidar/loop/stiffness_limit.h"

namespace spidar {
std::string MotionEngine::open(const MotionProperties& properties) {
  analyzer_.configure(properties.analyzer);
  if (properties.device == "none") return {};
  const std::string trace_problem =
      output_.open(properties.device, properties.profile, properties.haptic_trace);
  if (!output_.session()) return trace_problem;
  grip_pointer_ = GripPointer(output_.profile().geometry);
  schedule_.connect(&output_.session()->loop());
  limit_watch_.set_can_touch(output_.session()->grip().abilities().can_touch());
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
  const std::optional<LoopSnapshot> loop = output_.snapshot();
  describe_limits(limit_watch_.of_film(loop), limit_watch_.of_device(loop), structure);
  gst_structure_set(structure, "track-frames", G_TYPE_UINT64, player_.frames(), nullptr);
  reliefs_.describe(structure);
  output_.describe(structure);
  if (loop) {
    gst_structure_set(structure, "refused-wrenches", G_TYPE_UINT64,
                      schedule_.refused() + loop->counters.refused_wrenches, nullptr);
  }
  return structure;
}

NoForceReason MotionEngine::no_force_reason() const {
  return limit_watch_.first(output_.snapshot());
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

void MotionEngine::end_of_stream() {
  if (!pacer_.has_frame()) return;
  run_out(static_cast<GstClockTime>(pacer_.next_ns()));
  reliefs_.end(schedule_.at_sink_ns(pacer_.next_ns()));
}

void MotionEngine::set_track(std::optional<TrackFile> track) {
  player_.set_track(std::move(track).value_or(TrackFile{}));
}

void MotionEngine::touch_frame(const ImageView& luma, const TouchProperties& touch,
                               int64_t running_ns, FrameReport& report) {
  const HapticSession* const session = output_.session();
  if (touch.kind != TouchKind::kOff && session && !session->grip().abilities().can_touch()) {
    report.touch_problem = TouchProblem::kNoDepthAxis;
    return;
  }
  const Eigen::Vector2d middle(0.5, 0.5);
  const Eigen::Vector2d finger = turn_.place_coded(grip_place().value_or(middle));
  reliefs_.set_turn(turn_);
  reliefs_.add(luma, report.analysis, schedule_.at_sink_ns(running_ns), touch, finger);
  if (touch.kind == TouchKind::kOff) return;
  if (session == nullptr) {
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
}

}  // namespace spidar
