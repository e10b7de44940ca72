// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Frames that are touched by the grip of a device.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>
#include <gst/video/video.h>

#include "core/picture/image_view.h"
#include "plugin/filter/frame/frame_report.h"
#include "plugin/filter/frame/grip_pointer.h"
#include "plugin/filter/touch/relief_stream.h"
#include "plugin/output/haptic_output.h"
#include "plugin/properties/motion_properties.h"

namespace spidar {

/// Makes a relief of each frame while `touch` is on, and knows where the grip points at it. Methods
/// are grouped by the thread they belong to.
class FrameTouch {
 public:
  /// The engine's; it outlives this.
  explicit FrameTouch(const HapticOutput& output) : output_(output) {}

  // --- state changes

  /// The output's device was opened.
  void connect();
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
           int64_t shown_ns, FrameReport& report);
  /// No surface from this running time at the sink on.
  void end(int64_t shown_ns) { reliefs_.end(shown_ns); }
  /// Where the grip points at the picture as it is shown; nothing while no device runs.
  std::optional<Eigen::Vector2d> grip_place() const;

 private:
  const HapticOutput& output_;
  ReliefStream reliefs_;
  GripPointer grip_pointer_;
};

}  // namespace spidar
