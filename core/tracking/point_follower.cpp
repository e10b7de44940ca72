// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/point_follower.h"

#include <algorithm>
#include <cstddef>

#include "core/quantile.h"

namespace spidar {
namespace {

/// Where it was not expected more is asked for: smooth windows look like many others.
constexpr float kSameThingElsewhere = 0.35f;
/// A larger window may see something else beside: then its residual grows by this.
constexpr float kWiderWorse = 0.1f;
/// Followed back, a point comes to where it was, pixels of its level.
constexpr float kReturn_px = 0.5f;

/// Where a point is expected, the search begins at this level; where it is not, at the coarsest.
constexpr int kExpectedLevel = 1;
constexpr int kAnywhereLevel = GrayPyramid::kLevels - 1;
/// Blocks are compared at a level where 12 px are a jump; from there it is a pixel or two.
constexpr int kAfterBlocksLevel = 2;

/// Points that blocks are compared for in one frame: enough to find how a picture has jumped.
constexpr int kMostBlockSearches = 16;
/// After so many in vain it is another picture.
constexpr int kMostInVain = 8;

bool nearer_than(ImagePoint a, ImagePoint b, float px) {
  const ImagePoint d = a - b;
  return d.x_px * d.x_px + d.y_px * d.y_px < px * px;
}

bool has_room(const PaddedImage& image, ImagePoint p) {
  constexpr float kHalf_px = kSearchWindow_px / 2.0f;
  return p.x_px >= kHalf_px && p.y_px >= kHalf_px &&
         p.x_px <= static_cast<float>(image.width()) - 1 - kHalf_px &&
         p.y_px <= static_cast<float>(image.height()) - 1 - kHalf_px;
}

}  // namespace

struct PointFollower::Search {
  const GrayPyramid& before;
  const GrayPyramid& now;
  const Settings& settings;
  bool has_history;  ///< some points have been followed before

  /// `gain` of 0: of each window its own.
  bool find(FollowedPoint& point, ImagePoint expected, int first_level, float gain,
            float most_residual) const {
    SearchSettings search;
    search.first_level = first_level;
    search.last_level = point.level;
    search.gain = gain;
    search.least_strength = settings.least_strength;
    PointMatch match;
    if (!find_point(before, now, point.at, expected, search, match)) return false;
    if (match.residual > most_residual) return false;
    point.match = match;
    point.found = comes_back(point, search) && look_wider(point, search);
    return point.found;
  }

  bool find_elsewhere(FollowedPoint& point, ImagePoint expected, int first_level) const {
    return find(point, expected, first_level, 0, kSameThingElsewhere);
  }

 private:
  bool comes_back(const FollowedPoint& point, const SearchSettings& search) const {
    SearchSettings back = search;
    back.first_level = search.last_level;
    back.gain = search.gain > 0 ? 1 / search.gain : 0;
    back.least_strength = 0;
    const float reach_px = kReturn_px * static_cast<float>(1 << search.last_level);
    PointMatch returned;
    return find_point(now, before, point.match.to, point.at - point.match.to, back, returned) &&
           nearer_than(returned.to, point.at, reach_px);
  }

  /// Refines with a larger window, and asks it about points that were found elsewhere, and about
  /// all in the first frame, where none has a neighbour to agree with: false when it does not see
  /// the same thing. A small object does not fill it, so that others are not asked about.
  bool look_wider(FollowedPoint& point, const SearchSettings& search) const {
    const bool in_doubt = point.is_surprise || !has_history;
    if (!in_doubt && !settings.refines) return true;
    PointMatch wide;
    if (!refine_point(before, now, point.at, search, point.match, wide)) return true;
    if (in_doubt && wide.residual > kSameThing) return false;
    if (settings.refines && wide.residual < point.match.residual + kWiderWorse) {
      point.match.to = wide.to;
      point.match.variance_px2 = wide.variance_px2;
    }
    return true;
  }
};

void PointFollower::follow(const GrayPyramid& before, const GrayPyramid& now,
                           const Settings& settings, std::vector<FollowedPoint>& points) {
  const bool has_history = std::any_of(points.begin(), points.end(),
                                       [](const FollowedPoint& point) { return !point.is_new; });
  const Search search{before, now, settings, has_history};
  moved_x_.clear();
  moved_y_.clear();
  for (FollowedPoint& point : points) {
    point.found = false;
    point.is_surprise = false;
    if (!search.find(point, point.moved, kExpectedLevel, settings.gain, kSameThing)) continue;
    moved_x_.push_back(point.match.to.x_px - point.at.x_px);
    moved_y_.push_back(point.match.to.y_px - point.at.y_px);
  }
  if (moved_x_.size() == points.size()) return;

  bool others_moved = !moved_x_.empty();
  ImagePoint common;  // motion of the others
  if (others_moved)
    common = {median(moved_x_.begin(), moved_x_.end()), median(moved_y_.begin(), moved_y_.end())};
  int block_searches = 0;
  int in_vain = 0;
  for (FollowedPoint& point : points) {
    if (point.found) continue;
    point.is_surprise = true;
    // Where the others go it would leave: what looks like it elsewhere is not it.
    if (others_moved && !has_room(now.levels[0], point.at + common)) continue;
    if (others_moved && search.find_elsewhere(point, common, kExpectedLevel)) continue;
    if (search.find_elsewhere(point, {0, 0}, kAnywhereLevel)) continue;
    if (block_searches >= kMostBlockSearches || in_vain > kMostInVain) continue;
    ++block_searches;
    ImagePoint moved;
    if (find_by_blocks(before, now, point.at, moved) &&
        search.find_elsewhere(point, moved, kAfterBlocksLevel)) {
      common = point.match.to - point.at;
      others_moved = true;
      in_vain = 0;
    } else {
      ++in_vain;
    }
  }
}

}  // namespace spidar
