// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Converts coordinates between a frame and a picture reduced by an integer factor. Both have their
/// origin at the centre of the first pixel, so the conversion includes an offset.
#pragma once

#include "core/tracking/tracker.h"

namespace spidar {

inline float to_frame_px(float reduced_px, int factor) {
  return (reduced_px + 0.5f) * static_cast<float>(factor) - 0.5f;
}

inline ImagePoint to_frame(ImagePoint reduced, int factor) {
  return {to_frame_px(reduced.x_px, factor), to_frame_px(reduced.y_px, factor)};
}

inline ImagePoint to_reduced(ImagePoint frame, int factor) {
  const float scale = 1 / static_cast<float>(factor);
  return {(frame.x_px + 0.5f) * scale - 0.5f, (frame.y_px + 0.5f) * scale - 0.5f};
}

}  // namespace spidar
