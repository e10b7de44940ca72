// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/point_follower.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace spidar {
namespace {

/// At an unexpected place the match must be better, because smooth windows look like many others.
constexpr float kSameThingElsewhere = 0.35f;
/// The same for a larger window, which a small object does not fill.
constexpr float kSameSurroundings = 0.5f;
/// A larger window may also contain something else; its residual may then be larger by this.
constexpr float kWiderWorse = 0.1f;
/// A point that is followed back must return to where it was, up to this distance, pixels of its
/// level …
constexpr float kReturn_px = 0.5f;
/// … and up to this product of distance and residual. The worse the match, the more exactly it must
/// return: beside something that moves differently both are large. On pairs with true flow, 0.06
/// leaves 95 % of the tracks within 0.80 px instead of 0.68, and 0.02 loses a third more points.
constexpr float kReturnByResidual_px = 0.03f;

/// A new point whose window has a larger residual than this may see two things that move
/// differently, while the windows beside it see only one of them. The best of those is taken if its
/// residual is below kClearlyOneThing of the point's own or, where the point is not found at all,
/// below kOneThingBeside.
constexpr float kOneThing = 0.15f;
/// The same limit if points are refined in the frame. It is higher because a shifted point can be
/// refined only from the next frame on.
constexpr float kOneThingIfFiner = 0.3f;
constexpr float kClearlyOneThing = 0.8f;
constexpr float kOneThingBeside = 0.35f;
/// Half a window: each of the four windows beside the point shares a quarter of the point's own.
constexpr float kShift_px = kSearchWindow_px / 2.0f;
/// Lost points for which the windows beside are searched in one frame: those at edges of objects.
/// When nearly all points are lost, the picture shows something else.
constexpr int kMostShiftSearches = 32;

/// Where a point is expected, the search begins at this level; where it is not, at the coarsest.
constexpr int kExpectedLevel = 1;
constexpr int kAnywhereLevel = GrayPyramid::kLevels - 1;
/// Blocks are compared at a level where 12 px are a jump; from there the error is one or two
/// pixels.
constexpr int kAfterBlocksLevel = 2;

/// Number of neighbours whose motion is tried: beside the rim of an object, the nearest one may
/// belong to the object.
constexpr int kNeighbours = 3;
/// Motions that are less than this apart lead a search to the same end, px.
constexpr float kSameStart_px = 1;

/// Number of points in a frame for which blocks are compared: enough to find a jump of the whole
/// picture.
constexpr int kMostBlockSearches = 16;
/// After this many failures it is a different picture.
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

constexpr std::array<ImagePoint, 8> kAround{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};

/// Motion of the found points that are nearest to a place, the nearest first.
class Neighbours {
 public:
  Neighbours(const std::vector<FollowedPoint>& points, ImagePoint at) {
    for (const FollowedPoint& point : points) {
      if (!point.found) continue;
      const ImagePoint d = point.at - at;
      insert({d.x_px * d.x_px + d.y_px * d.y_px, point.match.to - point.at});
    }
  }

  int count() const { return count_; }
  ImagePoint moved(int k) const { return nearest_[static_cast<size_t>(k)].moved; }

  /// Whether `tried` or a neighbour before the k-th has the same motion.
  bool is_known(int k, ImagePoint tried) const {
    if (nearer_than(moved(k), tried, kSameStart_px)) return true;
    for (int i = 0; i < k; ++i) {
      if (nearer_than(moved(k), moved(i), kSameStart_px)) return true;
    }
    return false;
  }

 private:
  struct Neighbour {
    float distance_px2 = 0;
    ImagePoint moved;
  };

  void insert(const Neighbour& neighbour) {
    int k = count_;
    if (count_ < kNeighbours) {
      ++count_;
    } else if (neighbour.distance_px2 >= nearest_[kNeighbours - 1].distance_px2) {
      return;
    } else {
      k = kNeighbours - 1;
    }
    auto slot = static_cast<size_t>(k);
    for (; slot > 0 && nearest_[slot - 1].distance_px2 > neighbour.distance_px2; --slot) {
      nearest_[slot] = nearest_[slot - 1];
    }
    nearest_[slot] = neighbour;
  }

  std::array<Neighbour, kNeighbours> nearest_;
  int count_ = 0;
};

}  // namespace

struct PointFollower::Search {
  const GrayPyramid& before;
  const GrayPyramid& now;
  const Settings& settings;
  bool has_history;  ///< some points have been followed before

  /// Searches where the point was expected.
  bool find_expected(FollowedPoint& point, float most_residual = kSameThing) const {
    return find(point, point.moved, {kExpectedLevel, settings.gain, most_residual, !has_history});
  }

  /// Searches where its neighbours went, of which there must be at least one: their motion confirms
  /// the result.
  bool find_beside(FollowedPoint& point, const Neighbours& neighbours,
                   float most_residual = kSameThing) const {
    for (int k = 0; k < neighbours.count(); ++k) {
      if (neighbours.is_known(k, point.moved)) continue;
      const Attempt attempt{kExpectedLevel, settings.gain, most_residual, false};
      if (find(point, neighbours.moved(k), attempt)) return true;
    }
    return false;
  }

  /// Searches the windows next to that of a new point, at the expected displacement and, if there
  /// are neighbours, at theirs. Takes the best one with a residual below `most_residual`.
  bool find_shifted(FollowedPoint& point, const Neighbours* neighbours, float most_residual) const {
    if (!point.may_shift || point.level > 0) return false;
    FollowedPoint best;
    for (const ImagePoint& direction : kAround) {
      const ImagePoint shift{kShift_px * direction.x_px, kShift_px * direction.y_px};
      FollowedPoint beside = point;
      beside.at = point.at + shift;
      beside.is_shifted = true;
      if (!has_room(before.levels[0], beside.at)) continue;
      if (!find_expected(beside, most_residual) &&
          !(neighbours && find_beside(beside, *neighbours, most_residual))) {
        continue;
      }
      most_residual = beside.match.residual;
      best = beside;
    }
    if (best.found) point = best;
    return best.found;
  }

  bool find_elsewhere(FollowedPoint& point, ImagePoint expected, int first_level) const {
    point.is_surprise = find(point, expected, {first_level, 0, kSameThingElsewhere, true});
    return point.is_surprise;
  }

 private:
  struct Attempt {
    int first_level;
    float gain;  ///< 0: estimated per window
    float most_residual;
    bool in_doubt;
  };

  bool find(FollowedPoint& point, ImagePoint expected, const Attempt& attempt) const {
    SearchSettings search;
    search.first_level = attempt.first_level;
    search.last_level = point.level;
    search.gain = attempt.gain;
    search.least_strength = settings.least_strength;
    PointMatch match;
    if (!find_point(before, now, point.at, expected, search, match)) return false;
    if (match.residual > attempt.most_residual) return false;
    point.match = match;
    point.found = comes_back(point, search) && look_wider(point, search, attempt.in_doubt);
    return point.found;
  }

  bool comes_back(const FollowedPoint& point, const SearchSettings& search) const {
    SearchSettings back = search;
    back.first_level = search.last_level;
    back.gain = search.gain > 0 ? 1 / search.gain : 0;
    back.least_strength = 0;
    const float residual = std::max(point.match.residual, kReturnByResidual_px / kReturn_px);
    const float reach_px =
        kReturnByResidual_px / residual * static_cast<float>(1 << search.last_level);
    PointMatch returned;
    return find_point(now, before, point.match.to, point.at - point.match.to, back, returned) &&
           nearer_than(returned.to, point.at, reach_px);
  }

  /// Refines with a larger window and, in case of doubt, compares that window, too: returns false
  /// when it does not match. A small object does not fill it, so it is only compared for points
  /// that were found at an unexpected place, and for all points in the first frame, in which none
  /// has a history.
  bool look_wider(FollowedPoint& point, const SearchSettings& search, bool in_doubt) const {
    if (!in_doubt && !settings.refines) return true;
    PointMatch wide;
    if (!refine_point(before, now, point.at, search, point.match, wide)) return true;
    if (in_doubt && wide.residual > kSameSurroundings) return false;
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
  size_t found = 0;
  for (FollowedPoint& point : points) {
    point.found = false;
    point.is_surprise = false;
    if (!search.find_expected(point)) continue;
    ++found;
    const float residual = point.match.residual;
    if (residual > (settings.has_finer ? kOneThingIfFiner : kOneThing))
      search.find_shifted(point, nullptr, kClearlyOneThing * residual);
  }
  if (found == points.size()) return;

  int shift_searches = 0;
  int block_searches = 0;
  int in_vain = 0;
  for (FollowedPoint& point : points) {
    if (point.found) continue;
    const Neighbours neighbours(points, point.at);
    if (neighbours.count() > 0) {
      // If it moved like the others it would leave the picture, so a match elsewhere is wrong.
      if (!has_room(now.levels[0], point.at + neighbours.moved(0))) continue;
      if (search.find_beside(point, neighbours)) continue;
      if (shift_searches < kMostShiftSearches && point.may_shift) {
        ++shift_searches;
        if (search.find_shifted(point, &neighbours, kOneThingBeside)) continue;
      }
    }
    if (search.find_elsewhere(point, {0, 0}, kAnywhereLevel)) continue;
    if (block_searches >= kMostBlockSearches || in_vain > kMostInVain) continue;
    ++block_searches;
    ImagePoint moved;
    const bool found_by_blocks = find_by_blocks(before, now, point.at, moved) &&
                                 search.find_elsewhere(point, moved, kAfterBlocksLevel);
    in_vain = found_by_blocks ? 0 : in_vain + 1;
  }
}

}  // namespace spidar
