// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The two tables of a motion file.
#pragma once

#include <cstdint>
#include <vector>

#include "core/analysis/motion_codes.h"

namespace spidar {

/// What a row of the first table is about.
enum class MomentKind : uint8_t {
  kFrame,    ///< a frame that was measured
  kUnknown,  ///< a frame that was not, because of its time or its memory
  kNothing,  ///< there are no frames from here on, as the gap event of a demuxer says
};
constexpr int kMoments = 3;

/// One for each frame. Of a frame that waits, all up to `turn` is known.
struct FrameRow {
  int64_t stream_ns = 0;
  int64_t duration_ns = -1;  ///< -1: not known
  uint8_t moment = 0;
  uint8_t shown = 0;
  uint8_t anew = 0;
  uint8_t empty = 0;  ///< the buffer had no picture (GST_BUFFER_FLAG_GAP)
  uint8_t turn = 0;   ///< quarters clockwise, plus 4 when mirrored before
  uint32_t width = 0, height = 0;
  uint32_t features = 0;
  int64_t interval_ns = 0, shown_for_ns = 0;
  uint64_t mean_x = 0, mean_y = 0;  ///< of ImageMotion::velocity_px_s, as binary64
  uint32_t mean_tracked = 0;
  uint32_t votes = 0, dominant = 0;
  BackgroundCode background;
};

/// One for each object in each frame, ordered by id, and those of one id by frame.
struct ObjectRow {
  uint32_t frame = 0;  ///< row of the first table
  ObjectCode object;
};

struct MotionRows {
  std::vector<FrameRow> frames;
  std::vector<ObjectRow> objects;
};

}  // namespace spidar
