#include "core/tracking/patch_tracker.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "core/tracking/corner.h"
#include "core/tracking/gray_pyramid.h"
#include "core/tracking/light_change.h"
#include "core/tracking/pixel_scale.h"
#include "core/tracking/point_grid.h"
#include "core/tracking/pyramid_search.h"
#include "core/tracking/window_match.h"

namespace spidar {
namespace {

/// What a quality pays for.
struct Budget {
  double grid_share;  ///< of the points asked for, on the grid; the rest is for denser places
  bool refines;       ///< with larger windows, in the reduced picture and in the frame
};

Budget budget_of(TrackerQuality quality) {
  switch (quality) {
    case TrackerQuality::kFast:
      return {0.5, false};
    case TrackerQuality::kBalanced:
      return {0.5, true};
    case TrackerQuality::kFine:
      return {0.75, true};
  }
  return {0.5, true};
}

/// Cells become smaller while less than this share of the points asked for is in use …
constexpr double kFewInUse = 0.35;
/// … and larger again from this one on.
constexpr double kManyInUse = 0.9;
constexpr double kCellStep = 0.7071067811865476;  // twice as many cells
constexpr double kLeastCellScale = 0.3;

/// The same thing has a residual below this share of its contrast, see WindowMatch.
constexpr float kSameThing = 0.5f;
/// Where it was not expected more is asked for: smooth windows look like many others.
constexpr float kSameThingElsewhere = 0.35f;
/// A larger window may see something else beside: then its residual grows by this.
constexpr float kWiderWorse = 0.1f;
/// Followed back, a point comes to where it was, pixels of the reduced picture.
constexpr float kReturn_px = 0.5f;

/// A point that has been seen before begins at this level, where it was expected.
constexpr int kExpectedLevel = 1;

/// Points that blocks are compared for in one frame: enough to find how a picture has jumped.
constexpr int kMostBlockSearches = 16;

/// (grey / px)²: rounding to grey levels alone gives 0.04.
constexpr float kLeastStrength = 1;
/// A point that is followed may become weaker than a new one.
constexpr float kKeptStrength = 0.5f;

/// Refinement in the frame is worth it from this share of the reduced picture's structure on: a
/// window there has four times the pixels.
constexpr float kFineStrength = 0.25f;
constexpr int kFineWindow_px = 24;

/// A cut: at least kMinForCut points were looked for and fewer than this share was found.
constexpr double kFoundAfterCut = 0.1;
constexpr size_t kMinForCut = 10;

using FineTemplate = WindowTemplate<kFineWindow_px>;

struct Point {
  uint32_t id = 0;
  ImagePoint at;     ///< in the reduced picture
  ImagePoint frame;  ///< in the frame
  ImagePoint from;   ///< where that was in the frame before
  ImagePoint moved;  ///< since the frame before, in the reduced picture; expected of a new one
  bool is_new = true;

  bool found = false;        ///< in this frame
  bool has_place = false;    ///< on the grid
  bool is_surprise = false;  ///< found, but not from where it was expected
  PointMatch match;
};

ImagePoint operator-(ImagePoint a, ImagePoint b) {
  return {a.x_px - b.x_px, a.y_px - b.y_px};
}

bool nearer_than(ImagePoint a, ImagePoint b, float px) {
  const ImagePoint d = a - b;
  return d.x_px * d.x_px + d.y_px * d.y_px < px * px;
}

ImagePoint operator+(ImagePoint a, ImagePoint b) {
  return {a.x_px + b.x_px, a.y_px + b.y_px};
}

bool same_pixels(const PaddedImage& a, const PaddedImage& b) {
  for (int y = 0; y < a.height(); ++y) {
    if (std::memcmp(a.row(y), b.row(y), static_cast<size_t>(a.width())) != 0) return false;
  }
  return true;
}

}  // namespace

struct PatchTracker::Impl {
  TrackerSettings settings;
  Budget budget = budget_of(settings.quality);

  int width = 0;  // of the frame before; 0: there is none
  int height = 0;
  int factor = 1;
  GrayPyramid before;
  GrayPyramid now;

  std::vector<Point> points;       // the oldest first
  std::vector<FineTemplate> fine;  // of the points, in the frame before
  PointGrid grid;
  double cell_scale = 1;  // see adapt_cells()
  std::vector<Corner> candidates;
  std::vector<float> moved_x;  // buffers of median_motion()
  std::vector<float> moved_y;
  float strongest = 0;       // corner of late
  float strongest_next = 0;  // since the turn began
  int frames_in_turn = 0;
  uint32_t next_id = 0;

  TrackedFrame result;

  void track(const ImageView& frame);
  int cell_px() const;
  void adapt_cells();
  void stand_still();
  bool follow(const ImageView& frame);
  float least_strength() const;
  void search_expected(SearchSettings search);
  void search_lost(SearchSettings search);
  ImagePoint median_motion(size_t& found);
  bool try_from(Point& point, ImagePoint expected, const SearchSettings& search, float most);
  bool look_wider(Point& point, float gain);
  bool comes_back(const Point& point, const SearchSettings& search) const;
  ImagePoint refined(const Point& point, const FineTemplate& was, const ImageView& frame,
                     float gain) const;
  void settle(const ImageView& frame, float gain);
  void report();
  void drop_lost();
  void add_points(bool everywhere);
  void read_fine_templates(const ImageView& frame);
  bool is_in_picture(ImagePoint p) const;
  /// With factor 1 the reduced picture is the frame, and the search has refined it there.
  bool uses_fine() const { return budget.refines && factor > 1; }
};

void PatchTracker::Impl::track(const ImageView& frame) {
  const bool comparable = frame.width == width && frame.height == height;
  width = frame.width;
  height = frame.height;
  factor = halving_factor(width, height);

  std::swap(before, now);
  reduce_blocks(frame, factor, now.levels[0]);
  const PaddedImage& base = now.levels[0];
  if (!comparable) cell_scale = 1;
  grid.lay_out(base.width(), base.height(), cell_px());

  result.tracks.clear();
  result.restarted = !comparable;
  if (comparable && same_pixels(before.levels[0], base)) {
    std::swap(before, now);  // with its pyramid
    stand_still();
    return;
  }
  now.build_from_base();
  if (comparable && only_light_changed(before, now)) {
    stand_still();
    read_fine_templates(frame);
    return;
  }
  grid.begin_frame();
  if (!comparable) points.clear();
  if (comparable) result.restarted = !follow(frame);
  add_points(result.restarted);
  read_fine_templates(frame);
  result.features = static_cast<int>(points.size());
}

int PatchTracker::Impl::cell_px() const {
  const PaddedImage& base = now.levels[0];
  const double cells = budget.grid_share * settings.max_features;
  const double even_px = std::sqrt(base.width() * base.height() / cells);
  const double asked_px = settings.min_distance_px * height / kReferenceHeight_px / factor;
  return static_cast<int>(std::max(cell_scale * even_px, asked_px));
}

/// Where most of the picture shows nothing to follow the rest may have more of the points.
void PatchTracker::Impl::adapt_cells() {
  const auto in_use = static_cast<double>(points.size());
  const double most = settings.max_features;
  if (in_use < kFewInUse * most && cell_scale > kLeastCellScale) {
    cell_scale *= kCellStep;
  } else if (in_use > kManyInUse * most && cell_scale < 1) {
    cell_scale /= kCellStep;
  }
}

void PatchTracker::Impl::stand_still() {
  for (Point& point : points) {
    point.moved = {0, 0};
    result.tracks.push_back({point.id, point.frame, point.frame});
  }
  result.features = static_cast<int>(points.size());
}

float PatchTracker::Impl::least_strength() const {
  return std::max(kLeastStrength, static_cast<float>(settings.quality_level) * strongest);
}

bool PatchTracker::Impl::try_from(Point& point, ImagePoint expected, const SearchSettings& search,
                                  float most) {
  PointMatch match;
  if (!find_point(before, now, point.at, expected, search, match)) return false;
  if (match.residual > most) return false;
  point.match = match;
  point.found = comes_back(point, search) && look_wider(point, search.gain);
  return point.found;
}

/// Refines with a larger window, and asks it about points that were found for the first time or
/// elsewhere: false when it does not see the same thing.
bool PatchTracker::Impl::look_wider(Point& point, float gain) {
  const bool in_doubt = point.is_new || point.is_surprise;
  if (!in_doubt && !budget.refines) return true;
  PointMatch wide;
  if (!refine_point(before, now, point.at, gain, point.match, wide)) return true;
  if (in_doubt && wide.residual > kSameThing) return false;
  if (budget.refines && wide.residual < point.match.residual + kWiderWorse) {
    point.match.to = wide.to;
    point.match.variance_px2 = wide.variance_px2;
  }
  return true;
}

bool PatchTracker::Impl::comes_back(const Point& point, const SearchSettings& search) const {
  SearchSettings back = search;
  back.first_level = 0;
  back.gain = search.gain > 0 ? 1 / search.gain : 0;
  back.least_strength = 0;
  PointMatch returned;
  return find_point(now, before, point.match.to, point.at - point.match.to, back, returned) &&
         nearer_than(returned.to, point.at, kReturn_px);
}

void PatchTracker::Impl::search_expected(SearchSettings search) {
  search.first_level = kExpectedLevel;
  for (Point& point : points) {
    point.found = false;
    point.is_surprise = false;
    try_from(point, point.moved, search, kSameThing);
  }
}

ImagePoint PatchTracker::Impl::median_motion(size_t& found) {
  moved_x.clear();
  moved_y.clear();
  for (const Point& point : points) {
    if (!point.found) continue;
    moved_x.push_back(point.match.to.x_px - point.at.x_px);
    moved_y.push_back(point.match.to.y_px - point.at.y_px);
  }
  found = moved_x.size();
  if (found == 0) return {0, 0};
  const auto median = [](std::vector<float>& values) {
    const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  return {median(moved_x), median(moved_y)};
}

void PatchTracker::Impl::search_lost(SearchSettings search) {
  size_t found = 0;
  const ImagePoint common = median_motion(found);
  if (found == points.size()) return;
  search.gain = 0;
  int block_searches = 0;
  int in_vain = 0;
  ImagePoint jumped = common;
  for (Point& point : points) {
    if (point.found) continue;
    point.is_surprise = true;
    // Where the others go it would leave: what looks like it elsewhere is not it.
    if (found > 0 && !is_in_picture(point.at + jumped)) continue;
    search.first_level = kExpectedLevel;
    if (found > 0 && try_from(point, jumped, search, kSameThingElsewhere)) continue;
    search.first_level = GrayPyramid::kLevels - 1;
    if (try_from(point, {0, 0}, search, kSameThingElsewhere)) continue;
    if (block_searches >= kMostBlockSearches || in_vain > kMostBlockSearches / 2) continue;
    ++block_searches;
    ImagePoint moved;
    search.first_level = 2;
    if (find_by_blocks(before, now, point.at, moved) &&
        try_from(point, moved, search, kSameThingElsewhere)) {
      jumped = point.match.to - point.at;
      ++found;
      in_vain = 0;
    } else {
      ++in_vain;
    }
  }
}

bool PatchTracker::Impl::is_in_picture(ImagePoint p) const {
  const PaddedImage& base = now.levels[0];
  constexpr float kHalf_px = kSearchWindow_px / 2.0f;
  return p.x_px >= kHalf_px && p.y_px >= kHalf_px &&
         p.x_px <= static_cast<float>(base.width()) - 1 - kHalf_px &&
         p.y_px <= static_cast<float>(base.height()) - 1 - kHalf_px;
}

bool PatchTracker::Impl::follow(const ImageView& frame) {
  SearchSettings search;
  search.gain = contrast_gain(before, now);
  search.least_strength = kKeptStrength * least_strength();
  search_expected(search);
  search_lost(search);
  settle(frame, search.gain);
  report();
  const size_t looked_for = points.size();
  drop_lost();
  // What is found by chance does not agree with its neighbours and is not reported.
  const bool cut = looked_for >= kMinForCut && static_cast<double>(result.tracks.size()) <
                                                   kFoundAfterCut * static_cast<double>(looked_for);
  if (!cut) return true;
  result.tracks.clear();
  points.clear();
  return false;
}

/// Where the point is in the frame, from the reduced picture and, if it helps, from the frame.
ImagePoint PatchTracker::Impl::refined(const Point& point, const FineTemplate& was,
                                       const ImageView& frame, float gain) const {
  const auto scale = static_cast<float>(factor);
  const ImagePoint moved = point.match.to - point.at;
  const ImagePoint coarse{point.frame.x_px + scale * moved.x_px,
                          point.frame.y_px + scale * moved.y_px};
  if (!uses_fine() || scale * scale * was.strength() < kFineStrength * point.match.strength)
    return coarse;
  MatchSettings settings_px;
  settings_px.iterations = 3;
  settings_px.step_px = 0.03f;
  settings_px.reach_px = 0.5f + 0.5f * scale;
  settings_px.gain = gain;
  WindowMatch match{coarse, 0};
  if (!was.find(ReadablePixels(frame), settings_px, match)) return coarse;
  if (match.residual > kSameThing) return coarse;
  const float coarse_px2 = scale * scale * point.match.variance_px2;
  const float both_px2 = coarse_px2 + match.variance_px2;
  const float share = both_px2 > 0 ? coarse_px2 / both_px2 : 1;
  return {coarse.x_px + share * (match.centre.x_px - coarse.x_px),
          coarse.y_px + share * (match.centre.y_px - coarse.y_px)};
}

/// Brings the points to the new frame.
void PatchTracker::Impl::settle(const ImageView& frame, float gain) {
  for (size_t i = 0; i < points.size(); ++i) {
    Point& point = points[i];
    if (!point.found) {
      grid.lose(point.at);
      continue;
    }
    const ImagePoint to = refined(point, fine[i], frame, gain);
    const ImagePoint reduced = to_reduced(to, factor);
    point.moved = reduced - point.at;
    point.at = reduced;
    point.from = std::exchange(point.frame, to);
    point.is_new = false;
    point.has_place = grid.occupy(point.at, point.moved);
  }
  grid.compare_neighbours();
}

/// A point that moves like none of its neighbours is followed, but nobody is told: it is an error,
/// or else an object whose other points come with the next frames.
void PatchTracker::Impl::report() {
  for (const Point& point : points) {
    if (!point.found) continue;
    const PointGrid::Support support = grid.support(point.at, point.moved);
    const bool alone = support.beside == 0 && !point.is_surprise;
    if (support.alike == 0 && !alone) continue;
    result.tracks.push_back({point.id, point.from, point.frame});
  }
}

void PatchTracker::Impl::drop_lost() {
  const auto is_over = [](const Point& point) { return !point.found || !point.has_place; };
  points.erase(std::remove_if(points.begin(), points.end(), is_over), points.end());
}

void PatchTracker::Impl::add_points(bool everywhere) {
  candidates.clear();
  grid.for_each_wanted(everywhere, [this](const PixelBox& box) {
    const Corner corner = best_corner(now.levels[0], box);
    if (corner.strength > kLeastStrength) candidates.push_back(corner);
  });
  for (const Corner& corner : candidates) {
    strongest_next = std::max(strongest_next, corner.strength);
  }
  for (const Point& point : points) {
    strongest_next = std::max(strongest_next, point.match.strength);
  }
  strongest = everywhere ? strongest_next : std::max(strongest, strongest_next);
  if (++frames_in_turn >= PointGrid::kTurns) {
    adapt_cells();
    strongest = strongest_next;
    strongest_next = 0;
    frames_in_turn = 0;
  }
  const auto most = static_cast<size_t>(settings.max_features);
  for (const Corner& corner : candidates) {
    if (points.size() >= most) break;
    if (corner.strength < least_strength()) continue;
    Point point;
    point.id = next_id++;
    point.at = corner.at;
    point.moved = grid.motion_near(corner.at);
    point.frame = to_frame(corner.at, factor);
    points.push_back(point);
  }
  if (points.size() > most) points.resize(most);
}

void PatchTracker::Impl::read_fine_templates(const ImageView& frame) {
  fine.resize(points.size());
  if (!uses_fine()) return;
  const ReadablePixels pixels(frame);
  for (size_t i = 0; i < points.size(); ++i) fine[i].read(pixels, points[i].frame);
}

PatchTracker::PatchTracker(const TrackerSettings& settings) : impl_(std::make_unique<Impl>()) {
  configure(settings);
}

PatchTracker::~PatchTracker() = default;

const TrackedFrame& PatchTracker::track(const ImageView& frame) {
  require_usable(frame);
  impl_->track(frame);
  return impl_->result;
}

void PatchTracker::restart() {
  impl_->width = 0;
  impl_->height = 0;
}

void PatchTracker::configure(const TrackerSettings& settings) {
  validate(settings);
  impl_->settings = settings;
  impl_->budget = budget_of(settings.quality);
}

}  // namespace spidar
