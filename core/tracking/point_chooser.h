// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Chooses new points to follow.
#pragma once

#include <cstdint>
#include <vector>

#include "core/tracking/corner.h"
#include "core/tracking/followed_point.h"
#include "core/tracking/gray_pyramid.h"
#include "core/tracking/point_grid.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Fills a grid with the strongest corners of its cells. All cells become smaller when most of the
/// picture has no corners, so that the rest gets more points.
class PointChooser {
 public:
  struct Settings {
    TrackerSettings tracker;
    double grid_share = 0.5;     ///< of the requested points; the rest goes to dense cells
    double min_distance_px = 0;  ///< in the base
  };

  /// Call when the next picture is unrelated to the previous ones.
  void reset();

  /// Lays out `grid` over `base`.
  void lay_out(const PaddedImage& base, const Settings& settings, PointGrid& grid) const;

  /// Whether the number of points has reached the limit for dense cells.
  bool is_scarce(const Settings& settings, size_t points) const;

  /// Minimum strength of an existing point, lower than that of a new one, (grey / px)².
  float least_kept_strength(const Settings& settings) const;

  /// The extent of the search.
  struct Search {
    bool everywhere = false;  ///< otherwise only the cells whose turn it is
    bool coarser = false;  ///< also with larger windows, because points from small ones do not last
  };

  /// Adds points of `picture` wherever the grid needs them.
  void choose(const GrayPyramid& picture, const Settings& settings, const PointGrid& grid,
              const Search& search, std::vector<FollowedPoint>& points);

 private:
  /// A corner, in pixels of the base, and its pyramid level.
  struct Candidate {
    Corner corner;
    int level = 0;
    bool is_first = true;  ///< first point of its cell
  };

  float least_strength(const Settings& settings) const;
  void add(bool first, size_t most, const Settings& settings, const PointGrid& grid,
           std::vector<FollowedPoint>& points);
  void find_corners(const GrayPyramid& picture, int level, const PointGrid& grid, bool everywhere);
  void find_candidates(const GrayPyramid& picture, const PointGrid& grid, const Search& search,
                       std::vector<FollowedPoint>& points);
  void learn_strength(const std::vector<FollowedPoint>& points, bool everywhere);
  void adapt_cells(size_t points, int most);

  std::vector<Candidate> candidates_;
  double cell_scale_ = 1;
  float strongest_ = 0;       ///< strength of the strongest recent corner
  float strongest_next_ = 0;  ///< the same since the turn began
  int frames_in_turn_ = 0;
  uint32_t next_id_ = 0;
};

}  // namespace spidar
