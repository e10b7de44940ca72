// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Which points of a picture are followed from now on.
#pragma once

#include <cstdint>
#include <vector>

#include "core/tracking/corner.h"
#include "core/tracking/followed_point.h"
#include "core/tracking/gray_pyramid.h"
#include "core/tracking/point_grid.h"
#include "core/tracking/tracker.h"

namespace spidar {

/// Fills a grid with the strongest corners of its cells. Cells become smaller where most of the
/// picture shows nothing to follow, so that the rest may have more of the points.
class PointChooser {
 public:
  struct Settings {
    TrackerSettings tracker;
    double grid_share = 0.5;     ///< of the points asked for, on the grid; the rest: denser places
    double min_distance_px = 0;  ///< in the base
  };

  /// A picture that has nothing to do with those before.
  void reset();

  /// Lays out `grid` over `base`.
  void lay_out(const PaddedImage& base, const Settings& settings, PointGrid& grid) const;

  /// Whether so many points are in use that dense cells have taken what they may.
  bool is_scarce(const Settings& settings, size_t points) const;

  /// A point that is followed may become weaker than a new one, down to this, (grey / px)².
  float least_kept_strength(const Settings& settings) const;

  /// What of the picture is searched.
  struct Search {
    bool everywhere = false;  ///< else only the cells whose turn it is
    bool coarser = false;     ///< with larger windows, too: what small ones find does not last
  };

  /// Adds points of `picture` where the grid wants them.
  void choose(const GrayPyramid& picture, const Settings& settings, const PointGrid& grid,
              const Search& search, std::vector<FollowedPoint>& points);

 private:
  /// A corner, in pixels of the base, and the level of the pyramid that it is one of.
  struct Candidate {
    Corner corner;
    int level = 0;
    bool is_first = true;  ///< of its cell
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
  float strongest_ = 0;       ///< corner of late
  float strongest_next_ = 0;  ///< since the turn began
  int frames_in_turn_ = 0;
  uint32_t next_id_ = 0;
};

}  // namespace spidar
