// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// One point of a picture, looked for in the next one from coarse to fine.
#pragma once

#include "core/tracking/gray_pyramid.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Side of the windows that are compared, pixels of each level.
constexpr int kSearchWindow_px = 8;

struct PointMatch {
  ImagePoint to;       ///< pixels of the base
  float residual = 0;  ///< see WindowMatch
  float variance_px2 = 0;
  float strength = 0;  ///< of the window in the picture before, (grey / px)²
};

struct SearchSettings {
  int first_level = GrayPyramid::kLevels - 1;  ///< the coarsest that is looked at
  int last_level = 0;                          ///< the finest, where the point was chosen
  float gain = 1;                              ///< see MatchSettings
  float least_strength = 1;                    ///< a weaker window is not followed
};

/// Looks for the window around `from` of `before` near from + expected in `now`. Strength and
/// variance are those of the last level, in pixels of the base. False when there is nothing to
/// follow, it leaves the picture, or the search does not come to an end near where it
/// began. Whether it is the same thing is left to the caller: see the residual.
bool find_point(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from,
                ImagePoint expected, const SearchSettings& settings, PointMatch& match);

constexpr int kRefineWindow_px = 16;

/// The same with a window of four times the pixels, from `match` on; one level finer than the last,
/// if there is one. `wide` is then nearer to the truth, unless that window sees more than one
/// thing, which its residual tells. False when it would reach over the border.
bool refine_point(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from,
                  const SearchSettings& settings, const PointMatch& match, PointMatch& wide);

/// Displacement of least absolute difference within 12 px of the coarsest level, that is 96 px of
/// the base: for points that have jumped further than Gauss–Newton finds. False when
/// nothing looks alike or two places look alike.
bool find_by_blocks(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from,
                    ImagePoint& moved);

}  // namespace spidar
