// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Points of one picture, found in the next.
#pragma once

#include <vector>

#include "core/tracking/followed_point.h"
#include "core/tracking/gray_pyramid.h"
#include "core/tracking/pyramid_search.h"

namespace spidar {

/// Sets found, is_surprise and match of points. Each is looked for where it was expected, then
/// where its neighbours went, then at rest, and at last by comparing blocks. It is found if it
/// looks the same, comes back to where it was when it is followed backwards, and, in doubt, if its
/// surroundings agree.
class PointFollower {
 public:
  struct Settings {
    float least_strength = 1;  ///< a point that has become weaker is lost, (grey / px)²
    float gain = 1;            ///< of the light, see MatchSettings
    bool refines = true;       ///< with larger windows
    bool has_finer = false;    ///< the caller refines what is found, unless it is shifted
  };

  /// `before` and `now` are of one size.
  void follow(const GrayPyramid& before, const GrayPyramid& now, const Settings& settings,
              std::vector<FollowedPoint>& points);

  /// What passes for the same thing has a residual below this, see WindowMatch.
  static constexpr float kSameThing = 0.6f;

 private:
  struct Search;  // one frame's
};

}  // namespace spidar
