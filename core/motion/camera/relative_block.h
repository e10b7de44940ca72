// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A block compared with the background.
#pragma once

#include "core/field/block_field.h"

namespace spidar {

/// Pixels of a block whose errors are independent, of 256: coding and interpolation change
/// neighbours alike. Chosen on the first row of real films.
constexpr float kIndependentPixels = 16;
/// Variance of a block's mean difference that remains where its own motion explains every pixel,
/// grey²: that of rounding and of light that changes a little from position to position.
constexpr float kLeastVariance_grey2 = 0.5f;

/// Variance of a block's mean difference, grey².
inline float variance_grey2(const MotionBlock& block) {
  return block.residual / kIndependentPixels + kLeastVariance_grey2;
}

/// Properties of a block in addition to its motion. Lengths are in pixels of the field's picture.
struct RelativeBlock {
  float x_px = 0;  ///< motion relative to the background
  float y_px = 0;
  float background_x_px = 0;  ///< motion of the background at this position
  float background_y_px = 0;
  bool shows_motion = false;  ///< its texture, or its pixels, tell how it moves
  bool was_outside = false;   ///< most of it was outside of the film in the previous picture
  bool is_occluded = false;   ///< something burned in hides the film here, see BurnedIn::occludes()
  bool lasts = false;         ///< has stood out for so long that it moves without any neighbour
  bool moves = false;         ///< moves by itself, taking its neighbours into account
};

}  // namespace spidar
