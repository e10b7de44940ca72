// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/filter/engine/frame_touch.h"

#include "spidar/loop/stiffness_limit.h"

namespace spidar {

void FrameTouch::connect() {
  grip_pointer_ = GripPointer(output_.profile().geometry);
  reliefs_.connect(&output_.session()->loop(), output_.profile(), grip_pointer_.half_size_m());
}

std::optional<Eigen::Vector2d> FrameTouch::grip_place() const {
  const std::optional<LoopSnapshot> loop = output_.snapshot();
  if (!loop || loop->last.device != DeviceState::kRunning) return std::nullopt;
  return grip_pointer_.place(loop->last.pose.position_m);
}

void FrameTouch::add(const GstVideoFrame& frame, const ImageView& luma,
                     const TouchProperties& touch, int64_t shown_ns, FrameReport& report) {
  const HapticSession* const session = output_.session();
  if (touch.kind != TouchKind::kOff && session && !session->grip().abilities().can_touch()) {
    report.touch_problem = TouchProblem::kNoDepthAxis;
    return;
  }
  const Eigen::Vector2d middle(0.5, 0.5);
  const Eigen::Vector2d finger = report.turn.place_coded(grip_place().value_or(middle));
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
  report.touch.motion_share = touch.motion_share;
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
