// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The place of a piece of picture that is best to follow (Shi–Tomasi, eq. 1).
#pragma once

#include "core/tracking/gray_pyramid.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Centre of a window of kCornerWindow_px and how well it can be followed.
struct Corner {
  ImagePoint at;
  /// Smaller eigenvalue of the mean structure tensor of the window about its mean, (grey / px)²; 0
  /// when there is nothing or but an edge.
  float strength = 0;
};

/// Side of the window that eq. 1 sums over: that of the windows that are followed.
constexpr int kCornerWindow_px = 8;
/// Windows are looked at this many pixels apart.
constexpr int kCornerStep_px = 4;

/// Smaller eigenvalue over the larger one, at least: what looks less round is an edge, along which
/// only its noise would be followed.
constexpr float kLeastRoundness = 0.05f;

/// A piece of an image, in pixels; x1, y1 are the first outside.
struct PixelBox {
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;
};

/// Largest piece that best_corner() looks at, px a side.
constexpr int kMostCornerBox_px = 64;

/// The strongest of the windows that begin at the upper left corner of `box`, lie in it, and are
/// kCornerStep_px apart, and at least `least_roundness`. Derivatives are central differences. `box`
/// must lie in the image. A box smaller than a window has no corner.
Corner best_corner(const PaddedImage& image, const PixelBox& box,
                   float least_roundness = kLeastRoundness);

/// `corner` with its window where the gradients in it are: moved by whole pixels to the centre of
/// the gradients' squares, in two steps, as far as it lies in `box`; as it was where the window is
/// then none of `least_roundness`. Beside the rim of an object the centre of a window may show what
/// is behind it, while all that is found again is the rim.
Corner centred_corner(const PaddedImage& image, const PixelBox& box, const Corner& corner,
                      float least_roundness = kLeastRoundness);

namespace plain {
Corner best_corner(const PaddedImage& image, const PixelBox& box,
                   float least_roundness = kLeastRoundness);
}

}  // namespace spidar
