// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/point_chooser.h"

#include <algorithm>
#include <cmath>

#include "core/tracking/pixel_scale.h"

namespace spidar {
namespace {

/// Cells become smaller while less than this share of the points asked for is in use …
constexpr double kFewInUse = 0.35;
/// … and larger again from this one on.
constexpr double kManyInUse = 0.9;
constexpr double kCellStep = 0.7071067811865476;  // twice as many cells
constexpr double kLeastCellScale = 0.3;

/// Dense places may take points up to this share of those asked for.
constexpr double kDenseShare = 0.85;

/// Level of the pyramid: a window there is 32 px of the base.
constexpr int kCoarsestCorner = 2;
/// With this many points in the base, none is needed at a coarser level.
constexpr size_t kEnoughFinePoints = 24;

/// (grey / px)²: rounding to grey levels alone gives 0.04.
constexpr float kLeastStrength = 1;
constexpr float kKeptShare = 0.5f;

/// Least roundness of their windows. Where an edge crosses another one in front of it, the crossing
/// looks like a corner, but it belongs to nothing in the scene and moves on its own. On pairs with
/// true flow, points that are less round than this are wrong two to four times as often as others.
constexpr float kPointRoundness = 0.2f;

/// `box` of the base, in pixels of a coarser level; large enough for a window, inside the image.
PixelBox at_level(const PixelBox& box, int level, const PaddedImage& image) {
  if (level == 0) return box;
  constexpr int kLeast_px = kCornerWindow_px + kCornerStep_px;
  const auto span = [level](int first, int last, int size, int& begin, int& end) {
    const int middle = (first + last) >> (level + 1);
    const int half = std::max((last - first) >> (level + 1), kLeast_px / 2);
    begin = std::max(middle - half, 1);
    end = std::min(middle + half, size - 1);
  };
  PixelBox scaled;
  span(box.x0, box.x1, image.width(), scaled.x0, scaled.x1);
  span(box.y0, box.y1, image.height(), scaled.y0, scaled.y1);
  return scaled;
}

/// Number of points up to which dense places are filled.
size_t dense_limit(const PointChooser::Settings& settings) {
  return static_cast<size_t>(kDenseShare * settings.tracker.max_features);
}

}  // namespace

void PointChooser::reset() {
  cell_scale_ = 1;
  strongest_ = 0;
  strongest_next_ = 0;
  frames_in_turn_ = 0;
}

void PointChooser::lay_out(const PaddedImage& base, const Settings& settings,
                           PointGrid& grid) const {
  const double cells = settings.grid_share * settings.tracker.max_features;
  const double even_px = std::sqrt(base.width() * base.height() / cells);
  const double cell_px = std::max(cell_scale_ * even_px, settings.min_distance_px);
  grid.lay_out(base.width(), base.height(), static_cast<int>(cell_px));
}

bool PointChooser::is_scarce(const Settings& settings, size_t points) const {
  return points >= dense_limit(settings);
}

float PointChooser::least_strength(const Settings& settings) const {
  return std::max(kLeastStrength, static_cast<float>(settings.tracker.quality_level) * strongest_);
}

float PointChooser::least_kept_strength(const Settings& settings) const {
  return kKeptShare * least_strength(settings);
}

/// Finds candidates of a level wherever the grid needs a point.
void PointChooser::find_corners(const GrayPyramid& picture, int level, const PointGrid& grid,
                                bool everywhere) {
  const PaddedImage& image = picture.levels[static_cast<size_t>(level)];
  grid.for_each_wanted(everywhere, [&](const PixelBox& box, bool is_empty) {
    const PixelBox there = at_level(box, level, image);
    const Corner best = best_corner(image, there, kPointRoundness);
    if (best.strength <= kLeastStrength) return;
    const Corner found = centred_corner(image, there, best, kPointRoundness);
    candidates_.push_back({{to_frame(found.at, 1 << level), found.strength}, level, is_empty});
  });
}

/// The rim of a disc is an edge in a small window but a corner in a large one, which also contains
/// the background. Large windows are therefore used only in pictures with hardly anything else.
void PointChooser::find_candidates(const GrayPyramid& picture, const PointGrid& grid,
                                   const Search& search, std::vector<FollowedPoint>& points) {
  candidates_.clear();
  find_corners(picture, 0, grid, search.everywhere);
  const auto is_coarse = [](const FollowedPoint& point) { return point.level > 0; };
  const auto coarse = static_cast<size_t>(std::count_if(points.begin(), points.end(), is_coarse));
  const size_t fine = points.size() - coarse;
  if (fine >= kEnoughFinePoints) {
    points.erase(std::remove_if(points.begin(), points.end(), is_coarse), points.end());
    return;
  }
  const size_t found = candidates_.size();
  if (found > 0 && !search.coarser) return;
  for (int level = 1; level <= kCoarsestCorner && candidates_.size() == found; ++level) {
    find_corners(picture, level, grid, search.everywhere);
  }
}

/// Takes the strongest corner from the last turn through the cells, so that the value can also
/// decrease.
void PointChooser::learn_strength(const std::vector<FollowedPoint>& points, bool everywhere) {
  for (const Candidate& candidate : candidates_) {
    strongest_next_ = std::max(strongest_next_, candidate.corner.strength);
  }
  for (const FollowedPoint& point : points) {
    strongest_next_ = std::max(strongest_next_, point.match.strength);
  }
  strongest_ = everywhere ? strongest_next_ : std::max(strongest_, strongest_next_);
}

void PointChooser::adapt_cells(size_t points, int most) {
  const auto in_use = static_cast<double>(points);
  if (in_use < kFewInUse * most && cell_scale_ > kLeastCellScale) {
    cell_scale_ *= kCellStep;
  } else if (in_use > kManyInUse * most && cell_scale_ < 1) {
    cell_scale_ /= kCellStep;
  }
}

void PointChooser::choose(const GrayPyramid& picture, const Settings& settings,
                          const PointGrid& grid, const Search& search,
                          std::vector<FollowedPoint>& points) {
  find_candidates(picture, grid, search, points);
  learn_strength(points, search.everywhere);
  if (++frames_in_turn_ >= PointGrid::kTurns) {
    adapt_cells(points.size(), settings.tracker.max_features);
    strongest_ = strongest_next_;
    strongest_next_ = 0;
    frames_in_turn_ = 0;
  }
  // The first point of any cell has priority over further points of other cells, and there is
  // always room for some first points.
  const auto most = static_cast<size_t>(settings.tracker.max_features);
  add(true, most, settings, grid, points);
  add(false, dense_limit(settings), settings, grid, points);
  if (points.size() > most) points.resize(most);
}

void PointChooser::add(bool first, size_t most, const Settings& settings, const PointGrid& grid,
                       std::vector<FollowedPoint>& points) {
  for (const auto& [corner, level, is_first] : candidates_) {
    if (points.size() >= most) return;
    if (is_first != first || corner.strength < least_strength(settings)) continue;
    FollowedPoint point;
    point.id = next_id_++;
    point.at = corner.at;
    point.level = level;
    point.moved = grid.motion_near(corner.at);
    points.push_back(point);
  }
}

}  // namespace spidar
