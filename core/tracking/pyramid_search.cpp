// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/pyramid_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/tracking/corner.h"
#include "core/tracking/pixel_scale.h"
#include "core/tracking/window_match.h"

namespace spidar {
namespace {

using SearchTemplate = WindowTemplate<kSearchWindow_px>;

/// Coarse levels only have to reach the basin of convergence of the next finer level.
constexpr MatchSettings kCoarse{3, 0.15f, 5, 1};
constexpr MatchSettings kLast{10, 0.03f, 5, 1};
constexpr MatchSettings kRefine{3, 0.02f, 1, 1};
/// The limit for a followed point is lower than for a new one.
constexpr float kKeptRoundness = kLeastRoundness / 2;
/// Share of the required strength that applies at coarse levels.
constexpr float kCoarseStrength = 0.25f;

/// Whether the whole window of `side` px is inside the image, without replicated border pixels.
bool is_inside(const PaddedImage& image, ImagePoint centre, int side) {
  const float kHalf = static_cast<float>(side) / 2;
  return centre.x_px >= kHalf && centre.y_px >= kHalf &&
         centre.x_px <= static_cast<float>(image.width()) - 1 - kHalf &&
         centre.y_px <= static_cast<float>(image.height()) - 1 - kHalf;
}

}  // namespace

bool find_point(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from,
                ImagePoint expected, const SearchSettings& settings, PointMatch& match) {
  const int first_level = std::max(settings.first_level, settings.last_level);
  ImagePoint moved = expected;  // in pixels of the base
  SearchTemplate window;
  WindowMatch found;
  for (int level = first_level; level >= settings.last_level; --level) {
    const auto l = static_cast<size_t>(level);
    const auto scale = static_cast<float>(1 << level);
    const ImagePoint centre = to_reduced(from, 1 << level);
    const bool is_last = level == settings.last_level;
    const float least = settings.least_strength * (is_last ? 1 : kCoarseStrength);
    const bool usable =
        window.read(ReadablePixels(before.levels[l]), centre) && window.strength() >= least;
    if (is_last && !(usable && window.roundness() >= kKeptRoundness)) return false;
    if (!usable) continue;
    MatchSettings matching = is_last ? kLast : kCoarse;
    matching.gain = settings.gain;
    found.centre = {centre.x_px + moved.x_px / scale, centre.y_px + moved.y_px / scale};
    const bool ended = window.find(ReadablePixels(now.levels[l]), matching, found);
    if (is_last && !(ended && is_inside(now.levels[l], found.centre, kSearchWindow_px))) {
      return false;
    }
    if (!ended) continue;
    moved = {scale * (found.centre.x_px - centre.x_px), scale * (found.centre.y_px - centre.y_px)};
  }
  const auto scale = static_cast<float>(1 << settings.last_level);
  match.to = {from.x_px + moved.x_px, from.y_px + moved.y_px};
  match.residual = found.residual;
  match.variance_px2 = scale * scale * found.variance_px2;
  match.strength = window.strength() / (scale * scale);
  return true;
}

bool refine_point(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from,
                  const SearchSettings& settings, const PointMatch& match, PointMatch& wide) {
  const int level = std::max(settings.last_level - 1, 0);
  const auto scale = static_cast<float>(1 << level);
  const PaddedImage& was = before.levels[static_cast<size_t>(level)];
  const PaddedImage& is = now.levels[static_cast<size_t>(level)];
  const ImagePoint centre = to_reduced(from, 1 << level);
  WindowMatch found;
  found.centre = to_reduced(match.to, 1 << level);
  if (!is_inside(was, centre, kRefineWindow_px) || !is_inside(is, found.centre, kRefineWindow_px)) {
    return false;
  }
  WindowTemplate<kRefineWindow_px> window;
  if (!window.read(ReadablePixels(was), centre)) return false;
  MatchSettings matching = kRefine;
  matching.gain = settings.gain;
  if (!window.find(ReadablePixels(is), matching, found)) return false;
  wide.to = to_frame(found.centre, 1 << level);
  wide.residual = found.residual;
  wide.variance_px2 = scale * scale * found.variance_px2;
  wide.strength = window.strength() / (scale * scale);
  return true;
}

bool find_by_blocks(const GrayPyramid& before, const GrayPyramid& now, ImagePoint from,
                    ImagePoint& moved) {
  constexpr int kLevel = 3;
  constexpr int kReach_px = 12;
  constexpr int kSide_px = 8;
  constexpr int kNear_px = 2;  // the same minimum
  /// Mean absolute difference, grey levels.
  constexpr int kMostDifference = 24;
  const PaddedImage& a = before.levels[kLevel];
  const PaddedImage& b = now.levels[kLevel];
  if (a.width() < kSide_px || a.height() < kSide_px) return false;
  const ImagePoint centre = to_reduced(from, 1 << kLevel);
  const auto corner = [](float middle, int size) {
    const int first = static_cast<int>(std::lround(middle - (kSide_px - 1) / 2.0f));
    return std::clamp(first, 0, size - kSide_px);
  };
  const int x0 = corner(centre.x_px, a.width());
  const int y0 = corner(centre.y_px, a.height());

  struct Best {
    int difference = std::numeric_limits<int>::max();
    int dx = 0;
    int dy = 0;
  };
  Best best;
  int second = std::numeric_limits<int>::max();
  const auto first_y = std::max(-kReach_px, -y0);
  const auto last_y = std::min(kReach_px, b.height() - kSide_px - y0);
  const auto first_x = std::max(-kReach_px, -x0);
  const auto last_x = std::min(kReach_px, b.width() - kSide_px - x0);
  for (int dy = first_y; dy <= last_y; ++dy) {
    for (int dx = first_x; dx <= last_x; ++dx) {
      const int difference = vectors::absolute_difference(a.row(y0) + x0, a.stride(),
                                                          b.row(y0 + dy) + x0 + dx, b.stride());
      const bool elsewhere = std::abs(dx - best.dx) > kNear_px || std::abs(dy - best.dy) > kNear_px;
      if (difference < best.difference) {
        if (elsewhere) second = best.difference;
        best = {difference, dx, dy};
      } else if (elsewhere) {
        second = std::min(second, difference);
      }
    }
  }
  moved = {static_cast<float>(best.dx * (1 << kLevel)),
           static_cast<float>(best.dy * (1 << kLevel))};
  return best.difference < kMostDifference * kSide_px * kSide_px &&
         static_cast<int64_t>(best.difference) * 10 < static_cast<int64_t>(second) * 9;
}

}  // namespace spidar
