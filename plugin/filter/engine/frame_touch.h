// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frames that are touched by the grip of a device.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/picture/image_view.h"
#include "plugin/filter/engine/passing_frame.h"
#include "plugin/filter/touch/relief_stream.h"
#include "plugin/frame/frame_report.h"
#include "plugin/output/haptic_output.h"

namespace spidar::filter {

/// Where the grip points at the picture as it is shown; nothing while no device runs.
inline std::optional<Eigen::Vector2d> grip_position(const HapticOutput& output) {
  const std::optional<LoopSnapshot> loop = output.snapshot();
  if (!loop || loop->last.device != DeviceState::kRunning) return std::nullopt;
  return GripPointer(output.profile().geometry).position(loop->last.pose.position_m);
}

/// Makes the relief of a frame that was analysed, whose brightness is `luma` and which the sink
/// shows at `shown_ns`. Fills in the fields of the report on touching. Streaming thread.
inline void touch_frame(const PassingFrame& passing, const ImageView& luma, int64_t shown_ns,
                        const HapticOutput& output, ReliefStream& reliefs, FrameReport& report) {
  const TouchProperties& touch = passing.settings.touch;
  const HapticSession* const session = output.session();
  const bool on = touch.kind != TouchKind::kOff;
  if (on && session && !session->grip().abilities().can_touch()) return;
  const Eigen::Vector2d middle(0.5, 0.5);
  reliefs.set_turn(report.turn);
  reliefs.set_levels(luma_levels(passing.video.info));
  reliefs.add(luma, report.frame, shown_ns, touch,
              report.turn.stored_position(grip_position(output).value_or(middle)),
              passing.settings.display.debug_window ? &report.touch.shading : nullptr);
  if (!on || !session) return;
  report.touch.on = true;
  report.touch.map = {GripPointer(output.profile().geometry), report.turn};
  report.touch.stiffness_N_m = contact_settings(touch, output.profile()).stiffness_N_m;
  report.touch.motion_fraction = touch.motion_fraction;
  if (const std::optional<LoopSnapshot> loop = output.snapshot()) {
    report.touch_mark = touch_mark(report.touch, loop->last);
  }
}

}  // namespace spidar::filter
