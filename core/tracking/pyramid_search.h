// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Searches a point of one picture in the next, from coarse to fine.
#pragma once

#include "core/tracking/gray_pyramid.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Side of the compared windows, in pixels of each level.
constexpr int kSearchWindow_px = 8;

struct PointMatch {
  ImagePoint to;       ///< pixels of the base
  float residual = 0;  ///< see WindowMatch
  float variance_px2 = 0;
  float strength = 0;  ///< of the window in the previous picture, (grey / px)²
};

struct SearchSettings {
  int first_level = GrayPyramid::kLevels - 1;  ///< coarsest level
  int last_level = 0;                          ///< finest level, at which the point was chosen
  float gain = 1;                              ///< see MatchSettings
  float least_strength = 1;                    ///< a weaker window is not followed
};

/// Searches the window around `from` of `before` near from + expected in `now`. Strength and
/// variance are those of the last level, in pixels of the base. Returns false if the window has too
/// little structure, leaves the picture, or the search moves too far from its start. The caller
/// judges the match by its residual.
bool find_point(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from,
                ImagePoint expected, const SearchSettings& settings, PointMatch& match);

constexpr int kRefineWindow_px = 16;

/// Refines `match` with a window of four times the pixels, one level finer than the last if there
/// is one. `wide` is more accurate unless the larger window contains more than one motion, which
/// its residual shows. Returns false if the window would cross the border.
bool refine_point(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from,
                  const SearchSettings& settings, const PointMatch& match, PointMatch& wide);

/// Finds the displacement with the smallest absolute difference within 12 px of the coarsest level
/// (96 px of the base), for jumps beyond the reach of Gauss–Newton. Returns false if there is no
/// good match or no unique one.
bool find_by_blocks(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from,
                    ImagePoint& moved);

}  // namespace spidar
