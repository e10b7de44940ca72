// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What became of one frame of video.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "core/analysis/frame.h"
#include "core/picture_turn.h"
#include "plugin/filter/frame/frame_luma.h"
#include "plugin/filter/frame/no_force_reason.h"
#include "plugin/filter/frame/touch_view.h"

namespace spidar {

enum class FrameProblem {
  kNone,
  kNoTimestamp,       ///< no PTS, or no time in it or its segment: it cannot be felt in time
  kSameTimestamp,     ///< as the frame before, or nearly so: no Δt to divide by
  kFallingTimestamp,  ///< before the frame before
  kTooSmall,          ///< less memory than the picture needs
  kNotShown,          ///< outside the segment, or cropped to less than FrameLuma::kSmallestSide
  kWrongSize,         ///< more or less than FrameLuma takes
  kSmallHalf,         ///< depth in a half leaves a picture of less than 16 px on a side
};

/// Why a frame cannot be touched as the properties say.
enum class TouchProblem {
  kNone,
  kNoDevice,     ///< none is open
  kNoDepthAxis,  ///< the device has none, see GripAbilities::can_touch()
  kTrack,        ///< a haptic track is played, and no frame is looked at
  kTooStiff,     ///< for the drives of this device: it is touched with less
  kLagUnknown,   ///< of the drives: it is touched with less
};

struct FrameReport {
  FrameProblem problem = FrameProblem::kNone;
  bool analyzed = false;
  /// In pixels of the frame as it is stored, with its times at the element, and its wrench turned.
  /// While a haptic track is played, only times and wrench.
  Frame frame;
  PictureTurn turn;                                   ///< of the frame before it is shown
  VisiblePart part;                                   ///< of the frame that was analysed
  int64_t took_ns = 0;                                ///< the analysis
  NoForceReason limit = NoForceReason::kNone;         ///< the frame's own reason, in the film
  NoForceReason device_limit = NoForceReason::kNone;  ///< of device and playback, at this moment
  TouchProblem touch_problem = TouchProblem::kNone;
  double stiffness_N_m = 0;  ///< that is rendered, with TouchProblem::kTooStiff and kLagUnknown
  TouchScene touch;
  std::optional<TouchMark> touch_mark;  ///< where the grip is when the frame passes the element
  bool trace_failed = false;            ///< the trace could not be written and was closed

  /// Nothing is known of the next frame. The memory of this one stays.
  void begin() {
    Frame memory = std::move(frame);
    memory.clear();
    *this = FrameReport();
    frame = std::move(memory);
  }
};

}  // namespace spidar
