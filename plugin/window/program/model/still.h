// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A small copy of a picture, to look back at.
#pragma once

#include <cstdint>
#include <vector>

#include "plugin/window/program/model/window_model.h"

namespace spidar {

/// RGBA, rows from the top, without padding.
struct Still {
  double time_s = 0;
  FrameFacts facts;
  int width = 0, height = 0;
  int frame_width = 0, frame_height = 0;  ///< of the frame that it was made from
  double pixel_aspect = 1;
  std::vector<uint8_t> rgba;
};

/// Averages squares of the smallest whole size that makes the picture no wider than `widest` (≥ 1).
/// `stride` ≥ 4 · width: bytes from row to row. Fills in width, height and rgba.
void shrink_into(Still& still, const uint8_t* rgba, int width, int height, int stride, int widest);

}  // namespace spidar
