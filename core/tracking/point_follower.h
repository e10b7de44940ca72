// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds points of one picture in the next.
#pragma once

#include <vector>

#include "core/tracking/followed_point.h"
#include "core/tracking/gray_pyramid.h"
#include "core/tracking/pyramid_search.h"

namespace spidar {

/// Sets `found`, `is_surprise` and `match` of the points. Searches each point at its expected
/// position, then with the motion of its neighbours, then at rest, and finally by block matching. A
/// point is found if its window matches, the backward search returns to its origin, and, in case of
/// doubt, its surroundings match as well.
class PointFollower {
 public:
  struct Settings {
    float least_strength = 1;  ///< a weaker point is lost, (grey / px)²
    float gain = 1;            ///< contrast gain, see MatchSettings
    bool refines = true;       ///< with larger windows
    bool has_finer = false;    ///< the caller refines the found points, except shifted ones
  };

  /// `before` and `now` must have the same size.
  void follow(const GrayPyramid& before, const GrayPyramid& now, const Settings& settings,
              std::vector<FollowedPoint>& points);

  /// Upper limit of the residual of an accepted match, see WindowMatch.
  static constexpr float kSameThing = 0.6f;

 private:
  struct Search;  // state of the search in one frame
};

}  // namespace spidar
