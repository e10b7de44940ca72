// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/patch_tracker.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/tracking/fine_window.h"
#include "core/tracking/followed_point.h"
#include "core/tracking/gray_pyramid.h"
#include "core/tracking/light_change.h"
#include "core/tracking/luma_neighbourhood.h"
#include "core/tracking/pixel_scale.h"
#include "core/tracking/point_chooser.h"
#include "core/tracking/point_follower.h"
#include "core/tracking/point_grid.h"
#include "core/tracking/repeated_picture.h"
#include "core/tracking/window_match.h"

namespace spidar {
namespace {

/// Work per quality setting.
struct Budget {
  double grid_share;  ///< see PointChooser::Settings
  bool refines;       ///< also with larger windows, in the reduced picture and in the frame
};

Budget budget_of(TrackerQuality quality) {
  switch (quality) {
    case TrackerQuality::kFast:
      return {0.5, false};
    case TrackerQuality::kBalanced:
      break;
    case TrackerQuality::kFine:
      return {0.75, true};
  }
  return {0.5, true};
}

/// A cut is detected when at least kMinForCut points were searched and less than this share was
/// found.
constexpr double kFoundAfterCut = 0.1;
constexpr size_t kMinForCut = 10;
/// If less than this share of the small windows is found again, their content does not persist, for
/// example JPEG ringing around an edge, which stays with the codec's blocks.
constexpr double kLastingShare = 0.5;
constexpr size_t kMinForLasting = 4;

}  // namespace

struct PatchTracker::Impl {
  PointChooser::Settings choice;
  Budget budget = budget_of(TrackerQuality::kBalanced);

  int width = 0;  // of the previous frame; 0 if there is none
  int height = 0;
  int factor = 1;
  GrayPyramid before;
  GrayPyramid now;
  RepeatedPicture repeated_picture;

  std::vector<FollowedPoint> points;  // oldest first
  std::vector<FineWindow>
      fine;  // of the points, in the previous frame; may be longer than `points`
  PointGrid grid;
  PointChooser chooser;
  PointFollower follower;
  LumaNeighbourhood neighbourhood;
  TrackedFrame result;
  bool small_windows_hold = true;  // in the last frame

  struct Tally {
    size_t looked_for = 0;
    size_t found = 0;
    double share() const {
      return looked_for > 0 ? static_cast<double>(found) / static_cast<double>(looked_for) : 0;
    }
  };

  void configure(const TrackerSettings& settings);
  void track(const ImageView& frame, Repeats repeats);
  bool repeats_picture(Repeats repeats);
  void begin_anew();
  void stand_still();
  bool follow(const ImageView& frame);
  template <typename Which>
  Tally count(Which&& which) const;
  ImagePoint place_in_frame(const FollowedPoint& point, const FineWindow& was,
                            const ImageView& frame, float gain);
  void settle(const ImageView& frame, float gain);
  void report();
  void drop_lost();
  void choose(const ImageView& frame);
  void read_fine_templates(const ImageView& frame);
  /// With factor 1 the reduced picture is the frame, so the search has already refined the points
  /// in it.
  bool uses_fine() const { return budget.refines && factor > 1; }
};

void PatchTracker::Impl::configure(const TrackerSettings& settings) {
  choice.tracker = settings;
  budget = budget_of(settings.quality);
  choice.grid_share = budget.grid_share;
}

bool PatchTracker::Impl::repeats_picture(Repeats repeats) {
  using Kind = RepeatedPicture::Kind;
  const Kind kind = repeated_picture.look(before.levels[0].view(), now.levels[0].view());
  const bool repeated = kind == Kind::kSame || (kind == Kind::kAlike && repeats == Repeats::kAlike);
  result.alike = kind == Kind::kAlike && !repeated;
  return repeated;
}

void PatchTracker::Impl::track(const ImageView& frame, Repeats repeats) {
  const bool comparable = frame.width == width && frame.height == height;
  width = frame.width;
  height = frame.height;
  factor = halving_factor(width, height);
  choice.min_distance_px = choice.tracker.min_distance_px * height / kReferenceHeight_px / factor;

  std::swap(before, now);
  reduce_blocks(frame, factor, now.levels[0]);
  result.restarted = !comparable;
  result.alike = false;
  if (!comparable) repeated_picture.restart();
  result.repeated = comparable && repeats_picture(repeats);
  if (result.repeated) {
    std::swap(before, now);  // with its pyramid
    if (repeats == Repeats::kSame) stand_still();
    return;
  }
  result.tracks.clear();
  now.build_from_base();
  if (comparable && only_light_changed(before, now)) {
    stand_still();
    read_fine_templates(frame);
    return;
  }
  if (!comparable) begin_anew();
  chooser.lay_out(now.levels[0], choice, grid);
  grid.begin_frame(chooser.is_scarce(choice, points.size()));
  if (comparable) result.restarted = !follow(frame);
  choose(frame);
}

void PatchTracker::Impl::begin_anew() {
  points.clear();
  small_windows_hold = true;
  chooser.reset();
  grid.reset();
}

void PatchTracker::Impl::stand_still() {
  result.tracks.clear();
  for (FollowedPoint& point : points) {
    point.moved = {0, 0};
    point.may_shift = false;
    result.tracks.push_back({point.id, point.frame, point.frame});
  }
  result.features = static_cast<int>(points.size());
}

template <typename Which>
PatchTracker::Impl::Tally PatchTracker::Impl::count(Which&& which) const {
  Tally tally;
  for (const FollowedPoint& point : points) {
    if (!which(point)) continue;
    ++tally.looked_for;
    if (point.found) ++tally.found;
  }
  return tally;
}

/// Returns false at a cut.
bool PatchTracker::Impl::follow(const ImageView& frame) {
  PointFollower::Settings settings;
  settings.least_strength = chooser.least_kept_strength(choice);
  settings.gain = contrast_gain(before, now);
  settings.refines = budget.refines;
  settings.has_finer = uses_fine();
  follower.follow(before, now, settings, points);
  settle(frame, settings.gain);
  report();
  const Tally small = count([](const FollowedPoint& point) { return point.level == 0; });
  const Tally large = count([](const FollowedPoint& point) { return point.level > 0; });
  small_windows_hold = small.looked_for < kMinForLasting || small.share() >= kLastingShare;
  drop_lost();
  // A point that was found by chance does not agree with its neighbours and is not reported.
  const size_t looked_for = small.looked_for + large.looked_for;
  const bool cut = looked_for >= kMinForCut &&
                   static_cast<double>(result.tracks.size()) <
                       kFoundAfterCut * static_cast<double>(looked_for) &&
                   large.share() < kLastingShare;
  if (cut) {
    result.tracks.clear();
    points.clear();
  }
  return !cut;
}

/// The position refined in the frame if that is more accurate, otherwise the position from the
/// reduced picture.
ImagePoint PatchTracker::Impl::place_in_frame(const FollowedPoint& point, const FineWindow& was,
                                              const ImageView& frame, float gain) {
  const auto scale = static_cast<float>(factor);
  const ImagePoint moved = point.match.to - point.at;
  const ImagePoint coarse{point.frame.x_px + scale * moved.x_px,
                          point.frame.y_px + scale * moved.y_px};
  // A shifted window has no template from the previous frame.
  if (!uses_fine() || point.is_shifted) return coarse;
  return was.place(neighbourhood, frame, factor,
                   {coarse, point.match.variance_px2, point.match.strength, gain});
}

/// Brings the points to the new frame.
void PatchTracker::Impl::settle(const ImageView& frame, float gain) {
  for (size_t i = 0; i < points.size(); ++i) {
    FollowedPoint& point = points[i];
    if (!point.found) {
      grid.lose(point.at);
      continue;
    }
    if (point.is_shifted) point.frame = to_frame(point.at, factor);
    point.from = point.frame;
    point.frame = place_in_frame(point, fine[i], frame, gain);
    const ImagePoint at = to_reduced(point.frame, factor);
    point.moved = at - point.at;
    point.at = at;
    point.is_new = false;
    point.may_shift = false;
    point.is_shifted = false;
    point.has_place = grid.occupy(point.at, point.moved);
  }
  grid.compare_neighbours();
  constexpr size_t kChangeLevel = 2;
  grid.notice_changes(before.levels[kChangeLevel], now.levels[kChangeLevel], 1 << kChangeLevel);
}

/// A point that moves like none of its neighbours is followed but not reported: it is either an
/// error, or an object whose other points will be found in the next frames.
void PatchTracker::Impl::report() {
  for (const FollowedPoint& point : points) {
    if (!point.found) continue;
    const PointGrid::Support support = grid.support(point.at, point.moved);
    const bool alone = support.beside == 0 && !point.is_surprise;
    if (support.alike == 0 && !alone) continue;
    result.tracks.push_back({point.id, point.from, point.frame});
  }
}

void PatchTracker::Impl::drop_lost() {
  const auto is_over = [](const FollowedPoint& point) { return !point.found || !point.has_place; };
  points.erase(std::remove_if(points.begin(), points.end(), is_over), points.end());
}

void PatchTracker::Impl::choose(const ImageView& frame) {
  chooser.choose(now, choice, grid, {result.restarted, !small_windows_hold}, points);
  for (FollowedPoint& point : points) {
    if (point.is_new) point.frame = to_frame(point.at, factor);
  }
  read_fine_templates(frame);
  result.features = static_cast<int>(points.size());
}

void PatchTracker::Impl::read_fine_templates(const ImageView& frame) {
  if (fine.size() < points.size()) fine.resize(points.size());
  if (!uses_fine()) return;
  for (size_t i = 0; i < points.size(); ++i) {
    fine[i].read(neighbourhood, frame, points[i].frame);
  }
}

PatchTracker::PatchTracker(const TrackerSettings& settings) : impl_(std::make_unique<Impl>()) {
  configure(settings);
}

PatchTracker::~PatchTracker() = default;

const TrackedFrame& PatchTracker::track(const ImageView& frame, Repeats repeats) {
  require_usable(frame);
  impl_->track(frame, repeats);
  return impl_->result;
}

void PatchTracker::restart() {
  impl_->width = 0;
  impl_->height = 0;
}

void PatchTracker::configure(const TrackerSettings& settings) {
  validate(settings);
  impl_->configure(settings);
}

}  // namespace spidar
