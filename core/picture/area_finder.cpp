// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/picture/area_finder.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "core/picture/opencv.h"
#include "core/picture/repeated_picture.h"

namespace spidar {
namespace {

/// A pixel of the reduced picture has changed if it differs by more than this many grey levels:
/// more than rounding and the changes of good encoders in a still picture.
constexpr uint8_t kChanged_grey = 3;
/// A change adds kRise to the level of a pixel, up to kMaxLevel, and each picture takes 1 from it.
/// From kLasts on, which takes two changes within some pictures, a pixel changes lastingly. After
/// at most kMaxLevel pictures without a change, its changes are forgotten.
constexpr uint8_t kRise = 8;
constexpr uint8_t kLasts = 2 * kRise - 2;
constexpr uint8_t kMaxLevel = 3 * kRise;
/// While nothing suggests a film in a part of the picture, one of this many pictures is examined.
constexpr int kLookEvery = 8;
/// A change between the first two pictures counts as lasting for the next kStays pictures.
constexpr uint8_t kFirstRise = kLasts + AreaFinder::kStays;

constexpr int kAreaCell_px = 8;

/// A side is straight if on this fraction of its length the changes begin within two lines of
/// pixels. The sides of a disc of 80 px have 0.2 and 0.3.
constexpr double kStraight = 0.4;
/// Depth of the search for a side: two cells, of which the outer one may have only one line.
constexpr int kNear_px = 2 * kAreaCell_px;
/// This fraction of the changes that begin at a side must also be in the newest picture: where an
/// object has left, nothing changes.
constexpr double kStillChanges = 0.1;
/// The smallest film: kSmallest of the picture's width and height, with kFilled of its cells
/// changing.
constexpr double kSmallest = 0.15;
constexpr double kFilled = 0.4;
/// A side is crossed if most of what is beside it changes, and a whole page is another film if most
/// of it changes at once.
constexpr double kMost = 0.5;
/// A film continues while it has one change for this many changes in another rectangle: an object
/// in a third of the width and height of a film of that size.
constexpr int kPartsThatGoOn = 9;
/// The widest bar beside a film, as a fraction of the picture: of 4:3 in 16:9.
constexpr double kMaxBar = 0.125;
/// How far a side may seem to move while it stays.
constexpr int kStaysWithin_px = 1;
/// How far beside a side changes count as crossing it.
constexpr int kBeside_px = kStaysWithin_px + 1;
/// How far the content of a rectangle must have moved to show whether its sides move with it. An
/// object that moves this far leaves two lines behind it at one side, and covers the pixels beside
/// the opposite side.
constexpr double kMoves_px = kBeside_px + kStaysWithin_px;

bool is_same(int a, int b) {
  return std::abs(a - b) <= kStaysWithin_px;
}

bool contains(const PicturePart& outer, const PicturePart& inner) {
  return inner.x >= outer.x - kStaysWithin_px && inner.y >= outer.y - kStaysWithin_px &&
         inner.x + inner.width <= outer.x + outer.width + kStaysWithin_px &&
         inner.y + inner.height <= outer.y + outer.height + kStaysWithin_px;
}

/// Whether the analysis leaves out bars of such widths at two opposite sides by itself (Margins).
bool are_bars(int one, int other, int across) {
  return std::abs(one - other) <= kAreaCell_px && std::max(one, other) <= kMaxBar * across;
}

bool is_same(const PicturePart& a, const PicturePart& b) {
  return contains(a, b) && contains(b, a);
}

cv::Mat mat_of(PaddedImage& map) {
  return {map.height(), map.width(), CV_8U, map.row(0), static_cast<size_t>(map.stride())};
}

/// Returns the number of pixels of `part` in which `map` is set.
int set_in(const PaddedImage& map, const PicturePart& part) {
  return cv::countNonZero(const_mat(part_of(map.view(), part)));
}

/// Returns the number of places along `part` where `map` is set at either of two columns or rows.
int set_along(const PaddedImage& map, const PicturePart& part, bool is_column, int at, int or_at) {
  if (std::min(at, or_at) < 0 || std::max(at, or_at) >= (is_column ? map.width() : map.height())) {
    return 0;
  }
  const ptrdiff_t next = is_column ? map.stride() : 1, to_line = is_column ? 1 : map.stride();
  const uint8_t* const begin = map.row(0) + (is_column ? part.y : part.x) * next;
  int set = 0;
  for (int k = 0; k < (is_column ? part.height : part.width); ++k) {
    set += (begin[k * next + at * to_line] | begin[k * next + or_at * to_line]) != 0;
  }
  return set;
}

}  // namespace

void AreaFinder::begin(const ImageView& picture) {
  *this = {};
  width_ = picture.width;
  height_ = picture.height;
  const auto cells = [](int px) { return (px + kAreaCell_px - 1) / kAreaCell_px; };
  cells_.resize(cells(width_), cells(height_));
  for (PaddedImage* const map : {&now_, &before_, &changed_, &levels_, &lasting_}) {
    map->resize(cells_.width() * kAreaCell_px, cells_.height() * kAreaCell_px);
    mat_of(*map).setTo(0);
  }
  store(picture);
}

void AreaFinder::store(const ImageView& picture) {
  for (int y = 0; y < height_; ++y) std::copy_n(picture.at(0, y), width_, now_.row(y));
}

/// Compares the picture with the one before, and stores it. Returns false if it shows the same.
bool AreaFinder::compare(const ImageView& picture) {
  using cv::v_uint8x16;
  const v_uint8x16 grey = cv::v_setall_u8(kChanged_grey), one = cv::v_setall_u8(1);
  const v_uint8x16 rise = cv::v_setall_u8(compared_ == 0 ? kFirstRise : kRise);
  const v_uint8x16 most = cv::v_setall_u8(kMaxLevel), lasts = cv::v_setall_u8(kLasts);
  std::swap(now_, before_);
  store(picture);
  const int width = width_;  // a local copy, because stored bytes may alias a member
  for (int y = 0; y < height_; ++y) {
    const uint8_t *const now = now_.row(y), *const before = before_.row(y);
    uint8_t *const changed = changed_.row(y), *const levels = levels_.row(y);
    uint8_t* const lasting = lasting_.row(y);
    for (int x = 0; x < width; x += 16) {  // the last vector ends in the padding
      const v_uint8x16 change = cv::v_absdiff(cv::v_load(now + x), cv::v_load(before + x)) > grey;
      const v_uint8x16 had = cv::v_load(levels + x) - one;  // saturates at 0
      const v_uint8x16 has = cv::v_min(had + (change & rise), most);
      cv::v_store(changed + x, change);
      cv::v_store(levels + x, has);
      cv::v_store(lasting + x, has >= lasts);
    }
  }
  const PicturePart all{0, 0, width_, height_};
  const int changes = set_in(changed_, all);
  if (changes == 0) return false;
  ++compared_;
  if (state_ == State::kPage && changes > kMost * width_ * height_) state_ = State::kSearching;
  const int lasting_before = std::exchange(lasting_pixels_, set_in(lasting_, all));
  // In a repeated picture, an encoder changes few of the pixels that change otherwise.
  const bool repeats = changes < double{RepeatedPicture::kFraction} * lasting_before &&
                       skipped_ < RepeatedPicture::kMaxAtOnce;
  skipped_ = repeats ? skipped_ + 1 : 0;
  return !repeats;
}

/// Marks the cells in which at least as many pixels change as a line of a cell has.
void AreaFinder::count_cells() {
  constexpr uint64_t kOnes = 0x0101010101010101u;
  for (int row = 0; row < cells_.height(); ++row) {
    for (int column = 0; column < cells_.width(); ++column) {
      uint64_t pixels = 0;  // of each column of pixels
      for (int y = row * kAreaCell_px; y < (row + 1) * kAreaCell_px; ++y) {
        uint64_t line;
        std::memcpy(&line, lasting_.row(y) + column * kAreaCell_px, sizeof line);
        pixels += line & kOnes;
      }
      cells_.row(row)[column] = (pixels * kOnes) >> 56 >= kAreaCell_px ? 255 : 0;
    }
  }
}

/// Whether most cells at each side of the picture change: the whole picture is the film.
bool AreaFinder::reach_all_borders() const {
  const int columns = cells_.width(), rows = cells_.height();
  const PicturePart all{0, 0, columns, rows};
  const auto reach = [&](bool is_column, int at) {
    return set_along(cells_, all, is_column, at, at) > kMost * (is_column ? rows : columns);
  };
  return reach(true, 0) && reach(true, columns - 1) && reach(false, 0) && reach(false, rows - 1);
}

/// The left (`is_column`) or upper side of the changes in `part`, or the right or lower one.
AreaFinder::Side AreaFinder::side_of(const PicturePart& part, bool is_column, bool is_far) const {
  const int across = is_column ? width_ : height_;
  const int first = is_column ? part.x : part.y;
  const int length = is_column ? part.height : part.width;
  const int begin = is_column ? part.y : part.x;
  // From outside inwards.
  const int outside = is_far ? first + (is_column ? part.width : part.height) - 1 : first;
  const int step = is_far ? -1 : 1;
  // The film may end in the next cell, by less than a line of that.
  const int from = std::clamp(outside - kStaysWithin_px * step, 0, across - 1);
  const ptrdiff_t inwards = is_column ? step : step * lasting_.stride();
  std::array<int, kNear_px + 1> begins{};
  for (int k = begin; k < begin + length; ++k) {
    const int x = is_column ? from : k, y = is_column ? k : from;
    const uint8_t* at = lasting_.row(y) + x;
    for (size_t i = 0; i < begins.size(); ++i, at += inwards) {
      if (at[0] == 0 || at[inwards] == 0) continue;
      ++begins[i];
      break;
    }
  }
  size_t best = 0;
  for (size_t i = 0; i + 1 < begins.size(); ++i) {
    if (begins[i] + begins[i + 1] > begins[best] + begins[best + 1]) best = i;
  }
  const int together = begins[best] + begins[best + 1];
  // The outer one of two lines may show only a part of the film.
  const int at = static_cast<int>(best) + (begins[best] < begins[best + 1] ? 1 : 0);
  Side side;
  side.at = from + at * step;
  const int beside = is_far ? across - 1 - side.at : side.at;
  side.is_border = (is_far ? across - 1 - outside : outside) == 0 && beside <= kStaysWithin_px + 1;
  const int changed = set_along(changed_, part, is_column, side.at, side.at + step);
  const bool is_line = together >= kStraight * length;
  side.is_straight = is_line && changed >= kStillChanges * together;
  side.is_left = is_line && !side.is_straight;
  return side;
}

/// Whether the changes are a rectangle that is neither the whole picture nor everything between two
/// bars. At most one of its sides may be invisible, as below a sky.
bool AreaFinder::has_straight_sides(Candidate& candidate) const {
  // side_of() looks inwards.
  if (candidate.part.width <= 2 * kNear_px || candidate.part.height <= 2 * kNear_px) return false;
  int inside = 0, straight = 0;
  for (size_t i = 0; i < candidate.sides.size(); ++i) {
    Side& side = candidate.sides[i];
    side = side_of(candidate.part, i < 2, i % 2 != 0);
    inside += !side.is_border;
    straight += !side.is_border && side.is_straight;
  }
  if (straight < 2 || inside - straight > (straight >= 3 ? 1 : 0)) return false;
  const auto& [left, right, top, bottom] = candidate.sides;
  if (are_bars(left.at, width_ - 1 - right.at, width_) && top.is_border && bottom.is_border) {
    return false;
  }
  if (are_bars(top.at, height_ - 1 - bottom.at, height_) && left.is_border && right.is_border) {
    return false;
  }
  const int x = left.is_border ? 0 : left.at, y = top.is_border ? 0 : top.at;
  candidate.part = {x, y, (right.is_border ? width_ : right.at + 1) - x,
                    (bottom.is_border ? height_ : bottom.at + 1) - y};
  return true;
}

/// The rectangle of the connected cells with the most changes.
std::optional<AreaFinder::Candidate> AreaFinder::best_candidate() const {
  std::optional<Candidate> best;
  if (reach_all_borders()) return best;
  cv::Mat labels, boxes, middles;
  const int parts =
      cv::connectedComponentsWithStats(const_mat(cells_.view()), labels, boxes, middles);
  for (int i = 1; i < parts; ++i) {
    const int* const box = boxes.ptr<int>(i);
    const int columns = box[cv::CC_STAT_WIDTH], rows = box[cv::CC_STAT_HEIGHT];
    const int x = box[cv::CC_STAT_LEFT] * kAreaCell_px, y = box[cv::CC_STAT_TOP] * kAreaCell_px;
    Candidate candidate;
    candidate.cells = box[cv::CC_STAT_AREA];
    if (columns < kSmallest * cells_.width() || rows < kSmallest * cells_.height()) continue;
    if (candidate.cells < kFilled * columns * rows) continue;
    if (best && candidate.cells <= best->cells) continue;
    candidate.part = {x, y, std::min(columns * kAreaCell_px, width_ - x),
                      std::min(rows * kAreaCell_px, height_ - y)};
    if (has_straight_sides(candidate)) best = candidate;
  }
  return best;
}

/// Whether the candidate has stayed for long enough.
bool AreaFinder::confirm(const Candidate& candidate) {
  bool stays = stayed_ > 0;
  for (size_t i = 0; i < candidate.sides.size(); ++i) {
    const Side &now = candidate.sides[i], &before = pending_.sides[i];
    stays = stays && now.is_border == before.is_border;
    if (now.is_straight && before.is_straight) stays = stays && is_same(now.at, before.at);
  }
  if (!stays) {
    pending_ = candidate;
    stayed_ = 0;
  }
  pending_.part = candidate.part;  // the more it has changed, the more exact
  for (size_t i = 0; i < 4; ++i) pending_.sides[i].is_left = candidate.sides[i].is_left;
  // Where an object was in the first two pictures, its sides seem to stay in the next one, too.
  return ++stayed_ >= kStays && compared_ > kStays;
}

/// Returns the number of sides of part_ beside which most of `map` is set.
int AreaFinder::crossed_sides(const PaddedImage& map) const {
  int crossed = 0;
  for (size_t i = 0; i < sides_.size(); ++i) {
    if (sides_[i].is_border) continue;
    const bool is_column = i < 2;
    const int at = sides_[i].at + (i % 2 != 0 ? kBeside_px : -kBeside_px);
    const int length = is_column ? part_.height : part_.width;
    crossed += set_along(map, part_, is_column, at, at) > kMost * length;
  }
  return crossed;
}

/// Restarts the search for the film.
void AreaFinder::search(State state, int64_t running_ns) {
  state_ = state;
  since_ns_ = running_ns;
  stayed_ = 0;
  // Earlier changes were elsewhere.
  mat_of(levels_).setTo(0);
  mat_of(lasting_).setTo(0);
}

/// Keeps, replaces or gives up the film that is found.
void AreaFinder::follow(const std::optional<Candidate>& candidate, bool is_confirmed,
                        int64_t running_ns) {
  if (!candidate || is_same(candidate->part, part_)) {
    since_ns_ = running_ns;
    return;
  }
  // The candidate belongs to another film, or to a part of this one, while the rest still changes.
  const bool is_part = contains(part_, candidate->part);
  const int others = set_in(lasting_, candidate->part);
  const int own = set_in(lasting_, part_) - (is_part ? others : 0);
  if (contains(candidate->part, part_) || kPartsThatGoOn * own > others) since_ns_ = running_ns;
  if (is_confirmed && running_ns - since_ns_ >= (is_part ? kSearch_ns : kRests_ns)) {
    settle(*candidate, running_ns);
  }
}

void AreaFinder::settle(const Candidate& candidate, int64_t running_ns) {
  state_ = State::kFound;
  part_ = candidate.part;
  sides_ = candidate.sides;
  since_ns_ = running_ns;
  crossed_ = 0;
}

/// Whether most of what begins at a side changes in the newest picture, and less beside it.
bool AreaFinder::stands(const Side& side, const PicturePart& part, bool is_column,
                        bool is_far) const {
  const int inwards = is_far ? -1 : 1, length = is_column ? part.height : part.width;
  const int beside = side.at - kBeside_px * inwards;
  const int inside = set_along(changed_, part, is_column, side.at, side.at + inwards);
  const int outside = set_along(changed_, part, is_column, beside, beside);
  return side.is_straight && inside > kMost * kStraight * length && outside < kMost * inside;
}

void AreaFinder::observe_motion(bool moves, double across_px, double down_px, int64_t running_ns) {
  if (!moves) stayed_ = std::min(stayed_, 1);  // what only flickers has no sides
  if (!is_guess() || stayed_ < 2) return;
  if (stayed_ == 2) moved_px_ = {};
  moved_px_[0] += across_px;
  moved_px_[1] += down_px;
  for (size_t axis = 0; axis < 2; ++axis) {
    if (std::abs(moved_px_[axis]) < kMoves_px) continue;
    bool shows = false, stays = true;
    for (size_t i = 2 * axis; i < 2 * axis + 2; ++i) {
      const Side& side = pending_.sides[i];
      if (side.is_border) continue;
      if (side.is_left) stayed_ = 0;  // an object has left it
      shows = true;
      stays = stays && stands(side, pending_.part, axis == 0, i % 2 != 0);
    }
    if (shows && stays) return settle(pending_, running_ns);
  }
}

/// The whole picture changes: it is the film, or the film between blurred copies of itself.
void AreaFinder::look_for_copies(const ImageView& picture, int64_t running_ns) {
  if (state_ == State::kFound || (copies_ns_ && running_ns - *copies_ns_ < kCopies_ns)) return;
  copies_ns_ = running_ns;
  const std::optional<PicturePart> found = sharp_sides_.find(picture);
  missed_ = found ? 0 : missed_ + 1;
  const bool was_between = state_ == State::kBetweenCopies;
  const auto differs = [](int a, int b) { return std::abs(a - b) > kAreaCell_px; };
  if (found && (!was_between || differs(found->x, part_.x) || differs(found->y, part_.y))) {
    state_ = State::kBetweenCopies;
    part_ = *found;
  } else if (was_between && missed_ > 1) {
    state_ = State::kWhole;
  }
}

void AreaFinder::observe(const ImageView& picture, int64_t running_ns, bool scrolls) {
  if (picture.width != width_ || picture.height != height_) {
    return begin(picture);
  }
  const bool is_new = compared_ <= 2 * kStays;
  const bool is_quiet = area() ? state_ == State::kBetweenCopies : stayed_ == 0 && !is_searching();
  passed_ = is_quiet && !is_new && !scrolls ? (passed_ + 1) % kLookEvery : 0;
  if (passed_ > 0) return;
  if (!compare(picture) && !scrolls) return;
  const bool has_scrolled = std::exchange(scrolls_, scrolls);
  if (scrolls && has_scrolled) search(State::kPage, running_ns);
  if (scrolls) return;
  if (state_ == State::kFound) {
    const int crossed = crossed_sides(lasting_);
    if (crossed_sides(changed_) > crossed) {
      search(State::kSearching, running_ns);
    } else {
      crossed_ = crossed >= 2 ? crossed_ + 1 : 0;
      if (crossed_ >= kStays) state_ = State::kWhole;
    }
  }
  if (state_ == State::kFound && !is_new && compared_ % kStays != 0) return;
  count_cells();
  if (state_ == State::kBetweenCopies || reach_all_borders()) look_for_copies(picture, running_ns);
  if (state_ == State::kBetweenCopies) return;
  const std::optional<Candidate> candidate = best_candidate();
  if (!candidate) stayed_ = 0;
  const bool is_confirmed = candidate && confirm(*candidate);
  if (state_ == State::kFound) return follow(candidate, is_confirmed, running_ns);
  const bool searches = is_searching();
  const int64_t searched_ns = searches ? running_ns - since_ns_ : 0;
  // Nothing that moves while a page does is a film.
  const bool may_be_page = searches && searched_ns < kSearch_ns && candidate &&
                           candidate->part != part_ && contains(candidate->part, part_);
  if (is_confirmed && !may_be_page) {
    settle(*candidate, running_ns);
  } else if (searched_ns >= (state_ == State::kPage ? kRests_ns : kSearch_ns)) {
    search(State::kWhole, running_ns);
    compared_ = 0;
  }
}

}  // namespace spidar
