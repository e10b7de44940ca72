// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frames that are touched by the grip of a device.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>
#include <gst/video/video.h>

#include "core/picture/image_view.h"
#include "plugin/filter/touch/relief_stream.h"
#include "plugin/frame/frame_report.h"
#include "plugin/frame/touch_view.h"
#include "plugin/output/haptic_output.h"
#include "plugin/properties/motion_properties.h"
#include "spidar/loop/stiffness_limit.h"

namespace spidar {

/// Makes a relief of each frame while `touch` is on, and knows where the grip points at it. Methods
/// are grouped by the thread they belong to.
class FrameTouch {
 public:
  /// The engine's; it outlives this.
  explicit FrameTouch(const HapticOutput& output) : output_(output) {}

  // --- state changes

  /// The output's device was opened.
  void connect() {
    grip_pointer_ = GripPointer(output_.profile().geometry);
    reliefs_.connect(&output_.session()->loop(), output_.profile(), grip_pointer_.half_size_m());
  }
  /// It is closed: releases what its loop has been reading.
  void disconnect() { reliefs_.disconnect(); }

  // --- any thread

  /// There is nothing to touch any more: the force of the contact ends at once.
  void forget() { reliefs_.forget(); }
  void set_muted(bool muted) { reliefs_.set_muted(muted); }
  void describe(GstStructure* structure) const { reliefs_.describe(structure); }

  // --- streaming thread

  /// The relief of a frame that was analysed, whose brightness is `luma` and which the sink shows
  /// at `shown_ns`. Fills in what the report says of touching.
  void add(const GstVideoFrame& frame, const ImageView& luma, const TouchProperties& touch,
           int64_t shown_ns, FrameReport& report) {
    const HapticSession* const session = output_.session();
    if (touch.kind != TouchKind::kOff && session && !session->grip().abilities().can_touch()) {
      report.touch_problem = TouchProblem::kNoDepthAxis;
      return;
    }
    const Eigen::Vector2d middle(0.5, 0.5);
    const Eigen::Vector2d finger = report.turn.stored_position(grip_position().value_or(middle));
    reliefs_.set_turn(report.turn);
    reliefs_.set_levels(luma_levels(frame.info));
    reliefs_.add(luma, report.frame, shown_ns, touch, finger);
    if (touch.kind == TouchKind::kOff) return;
    if (session == nullptr) {
      report.touch_problem = TouchProblem::kNoDevice;
      return;
    }
    report.touch.on = true;
    report.touch.map = {grip_pointer_, report.turn};
    report.touch.stiffness_N_m = contact_settings(touch, output_.profile()).stiffness_N_m;
    report.touch.motion_fraction = touch.motion_fraction;
    if (const std::optional<LoopSnapshot> loop = output_.snapshot()) {
      report.touch_mark = touch_mark(report.touch, loop->last);
    }
    report.stiffness_N_m = most_stiffness_N_m(output_.profile());
    if (touch.stiffness_N_m > report.stiffness_N_m) {
      report.touch_problem =
          output_.profile().drive_lag_known ? TouchProblem::kTooStiff : TouchProblem::kLagUnknown;
    }
  }
  /// No surface from this running time at the sink on.
  void end(int64_t shown_ns) { reliefs_.end(shown_ns); }
  /// Where the grip points at the picture as it is shown; nothing while no device runs.
  std::optional<Eigen::Vector2d> grip_position() const {
    const std::optional<LoopSnapshot> loop = output_.snapshot();
    if (!loop || loop->last.device != DeviceState::kRunning) return std::nullopt;
    return grip_pointer_.position(loop->last.pose.position_m);
  }

 private:
  const HapticOutput& output_;
  ReliefStream reliefs_;
  GripPointer grip_pointer_;
};

}  // namespace spidar
