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
  float gain = 1;                              ///< see MatchSettings
  float least_strength = 1;                    ///< a weaker window is not followed
};

/// Looks for the window around `from` of `before` near from + expected in `now`. False when there
/// is nothing to follow, it leaves the picture, or the search does not come to an end near where it
/// began. Whether it is the same thing is left to the caller: see the residual.
bool find_point(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from,
                ImagePoint expected, const SearchSettings& settings, PointMatch& match);

/// Brings `match` nearer to the truth with a window of four times the pixels. False, and nothing
/// changed, when it would reach over the border or sees more than one thing.
constexpr int kRefineWindow_px = 16;
bool refine_point(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from, float gain,
                  PointMatch& match);

/// Displacement of least absolute difference within about 8 px of a coarse level, that is
/// 64 px of the base: for points that have jumped further than Gauss–Newton finds. False when
/// nothing looks alike or two places look alike.
bool find_by_blocks(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from,
                    ImagePoint& moved);

/// Contrast of `now` over that of `before`; 1 when they differ by less than what things that come
/// and go change.
float contrast_gain(const GrayPyramid& before, const GrayPyramid& now);

}  // namespace spidar
