// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/picture/area_finder.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "core/picture/opencv.h"
#include "core/picture/repeated_picture.h"

namespace spidar {
namespace {

/// A pixel of the reduced picture has changed if it differs by more than so many grey levels: more
/// than rounding and what good encoders leave of a picture at rest.
constexpr uint8_t kChanged_grey = 3;
/// A change adds kRise to the level of a pixel, up to kMaxLevel, and each picture takes 1 from it.
/// From kLasts on, which takes two changes within some pictures, a pixel changes lastingly. After
/// at most kMaxLevel pictures without a change, its changes are forgotten.
constexpr uint8_t kRise = 8;
constexpr uint8_t kLasts = 2 * kRise - 2;
constexpr uint8_t kMaxLevel = 3 * kRise;
/// What changes between the first two pictures may be lasting.
constexpr uint8_t kFirstRise = kLasts + AreaFinder::kStays;

constexpr int kAreaCell_px = 8;
/// Lasting pixels of a cell that has them: one line of it.
constexpr int kLineOfCell = kAreaCell_px;

/// A side is straight if on so much of its length what changes begins within two lines of pixels.
/// The sides of a disc of 80 px have 0.2 and 0.3.
constexpr double kStraight = 0.4;
/// Two cells, of which the outer one may have a line only.
constexpr int kNear_px = 2 * kAreaCell_px;
/// So much of what begins at a side must have changed in the newest picture, too: where an object
/// has left, nothing does.
constexpr double kStillChanges = 0.1;
/// The smallest film, as a fraction of the picture's width and height, and of its cells that
/// change.
constexpr double kSmallest = 0.15;
constexpr double kFilled = 0.4;
/// A side is crossed if most of what is beside it changes, and all of a page is another film if
/// most of it changes at once.
constexpr double kMost = 0.5;
/// A film goes on while something changes in so much of what changes in another rectangle: an
/// object in a third of the width and height of a film of that size.
constexpr int kPartsThatGoOn = 9;
/// The widest bar beside a film, as a fraction of the picture: of 4:3 in 16:9.
constexpr double kMaxBar = 0.125;
/// By how much a side may seem to move while it stays.
constexpr int kStaysWithin_px = 1;
/// How far beside a side it is looked for what crosses it.
constexpr int kBeside_px = kStaysWithin_px + 1;
/// By so much what is in a rectangle must have moved to show whether its sides move with it: then
/// two lines at a side that an object leaves are behind it, and what is beside the other is in it.
constexpr double kMoves_px = kBeside_px + kStaysWithin_px;

bool is_same(int a, int b) {
  return std::abs(a - b) <= kStaysWithin_px;
}

/// The sum of eight bytes, below 256.
int sum_of_8(const uint8_t* bytes) {
  uint64_t eight;
  std::memcpy(&eight, bytes, sizeof eight);
  return static_cast<int>((eight * 0x0101010101010101u) >> 56);
}

bool contains(const PicturePart& outer, const PicturePart& inner) {
  return inner.x >= outer.x - kStaysWithin_px && inner.y >= outer.y - kStaysWithin_px &&
         inner.x + inner.width <= outer.x + outer.width + kStaysWithin_px &&
         inner.y + inner.height <= outer.y + outer.height + kStaysWithin_px;
}

/// Whether the analysis leaves out by itself what has such widths at two opposite sides (Margins).
bool are_bars(int one, int other, int across) {
  return std::abs(one - other) <= kAreaCell_px && std::max(one, other) <= kMaxBar * across;
}

bool is_same(const PicturePart& a, const PicturePart& b) {
  return contains(a, b) && contains(b, a);
}

/// Whether most cells at each of the four sides of the picture change: all of it is the film.
bool reach_all_borders(const std::vector<uint8_t>& cells, int columns, int rows) {
  const auto reach = [&](int first, int step, int count) {
    int lasting = 0;
    for (int i = 0; i < count; ++i) {
      lasting += cells[static_cast<size_t>(first + i * step)] >= kLineOfCell;
    }
    return lasting > kMost * count;
  };
  return reach(0, 1, columns) && reach((rows - 1) * columns, 1, columns) &&
         reach(0, columns, rows) && reach(columns - 1, columns, rows);
}

}  // namespace

void AreaFinder::begin(const ImageView& picture) {
  width_ = picture.width;
  height_ = picture.height;
  stride_ = (width_ + 15) / 16 * 16;
  const size_t size = static_cast<size_t>(stride_) * static_cast<size_t>(height_);
  before_.assign(size, 0);
  changed_.assign(size, 0);
  lasting_.assign(size, 0);
  columns_ = (width_ + kAreaCell_px - 1) / kAreaCell_px;
  rows_ = (height_ + kAreaCell_px - 1) / kAreaCell_px;
  cells_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), 0);
  open_.reserve(cells_.size());
  is_page_ = scrolls_ = skips_ = false;
  stayed_ = crossed_ = lasting_pixels_ = 0;
  skipped_ = 0;
  area_.reset();
  searches_since_ns_.reset();
}

/// Compares the picture with the one before, and keeps it. False if it shows the same.
bool AreaFinder::take(const ImageView& picture) {
  using cv::v_uint8x16;
  const v_uint8x16 zero = cv::v_setzero_u8(), one = cv::v_setall_u8(1);
  const v_uint8x16 rise = cv::v_setall_u8(compared_ == 0 ? kFirstRise : kRise);
  const v_uint8x16 most = cv::v_setall_u8(kMaxLevel), lasts = cv::v_setall_u8(kLasts);
  const v_uint8x16 grey = cv::v_setall_u8(kChanged_grey + 1);
  int changes = 0;
  // Bytes that are stored may be anything, members of this object among them, but not these.
  uint8_t* const before = before_.data();
  uint8_t* const changed_now = changed_.data();
  uint8_t* const levels = lasting_.data();
  const int width = width_, stride = stride_;
  const ptrdiff_t next = picture.stride_bytes;
  alignas(16) uint8_t sixteen[16];
  const int lasting_before = std::exchange(lasting_pixels_, 0);
  for (int row = 0; row < rows_; ++row) {
    const int below = std::min((row + 1) * kAreaCell_px, height_);
    for (int x = 0; x < width; x += 16) {
      v_uint8x16 changing = zero, lasting = zero;  // lines of the cells, for each column of pixels
      const uint8_t* from = picture.at(x, row * kAreaCell_px);
      ptrdiff_t at = row * kAreaCell_px * stride + x;
      for (int y = row * kAreaCell_px; y < below; ++y) {
        const uint8_t* pixels = from;
        if (x + 16 > width) {
          std::memset(sixteen, 0, sizeof sixteen);
          std::memcpy(sixteen, from, static_cast<size_t>(width - x));
          pixels = sixteen;
        }
        const v_uint8x16 now = cv::v_load(pixels);
        const v_uint8x16 changed = cv::v_absdiff(now, cv::v_load(before + at)) >= grey;
        const v_uint8x16 had = cv::v_load(levels + at) - one;  // not below 0
        const v_uint8x16 has = cv::v_min(had + (changed & rise), most);
        cv::v_store(before + at, now);
        cv::v_store(changed_now + at, changed);
        cv::v_store(levels + at, has);
        // What is true is 255, which is −1.
        changing = cv::v_sub_wrap(changing, changed);
        lasting = cv::v_sub_wrap(lasting, has >= lasts);
        from += next;
        at += stride;
      }
      cv::v_store(sixteen, changing);
      changes += sum_of_8(sixteen) + sum_of_8(sixteen + kAreaCell_px);
      cv::v_store(sixteen, lasting);
      for (int k = 0; k < 2 && x / kAreaCell_px + k < columns_; ++k) {
        const int count = sum_of_8(sixteen + k * kAreaCell_px);
        cells_[static_cast<size_t>(row * columns_ + x / kAreaCell_px + k)] =
            static_cast<uint8_t>(count);
        lasting_pixels_ += count;
      }
    }
  }
  if (changes == 0) return false;
  ++compared_;
  if (changes > kMost * width_ * height_) is_page_ = false;
  // Of a picture that is shown again, an encoder changes little of what changes otherwise.
  const bool repeats = changes < double{RepeatedPicture::kFraction} * lasting_before &&
                       skipped_ < RepeatedPicture::kMaxAtOnce;
  skipped_ = repeats ? skipped_ + 1 : 0;
  return !repeats;
}

/// Adds all cells that are connected to this one, and marks them as taken.
bool AreaFinder::grow(size_t cell, Candidate& candidate) {
  int left = columns_, right = -1, top = rows_, bottom = -1;
  candidate.cells = 0;
  open_.clear();
  open_.push_back(cell);
  cells_[cell] = 0;
  while (!open_.empty()) {
    const int column = static_cast<int>(open_.back()) % columns_;
    const int row = static_cast<int>(open_.back()) / columns_;
    open_.pop_back();
    ++candidate.cells;
    left = std::min(left, column);
    right = std::max(right, column);
    top = std::min(top, row);
    bottom = std::max(bottom, row);
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y) {
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x) {
        uint8_t& next = cells_[static_cast<size_t>(y * columns_ + x)];
        if (next < kLineOfCell) continue;
        next = 0;
        open_.push_back(static_cast<size_t>(y * columns_ + x));
      }
    }
  }
  const int columns = right - left + 1, rows = bottom - top + 1;
  candidate.part = {left * kAreaCell_px, top * kAreaCell_px,
                    std::min(columns * kAreaCell_px, width_ - left * kAreaCell_px),
                    std::min(rows * kAreaCell_px, height_ - top * kAreaCell_px)};
  return columns >= kSmallest * columns_ && rows >= kSmallest * rows_ &&
         candidate.cells >= kFilled * columns * rows;
}

/// The left (`is_column`) or upper side of what changes in `part`, or the right or lower one.
AreaFinder::Side AreaFinder::side_of(const PicturePart& part, bool is_column, bool is_far) const {
  const int across = is_column ? width_ : height_;
  const int first = is_column ? part.x : part.y;
  const int length = is_column ? part.height : part.width;
  const int begin = is_column ? part.y : part.x;
  // From outside inwards.
  const int outside = is_far ? first + (is_column ? part.width : part.height) - 1 : first;
  const int step = is_far ? -1 : 1;
  // A film that ends in the next cell, by less than a line of that.
  const int from = std::clamp(outside - kStaysWithin_px * step, 0, across - 1);
  const ptrdiff_t inwards = is_column ? step : step * stride_;
  std::array<int, kNear_px + 1> begins{};
  for (int k = begin; k < begin + length; ++k) {
    const int x = is_column ? from : k, y = is_column ? k : from;
    const uint8_t* at = &lasting_[static_cast<size_t>(y * stride_ + x)];
    for (size_t i = 0; i < begins.size(); ++i, at += inwards) {
      if (at[0] < kLasts || at[inwards] < kLasts) continue;
      ++begins[i];
      break;
    }
  }
  size_t best = 0;
  for (size_t i = 0; i + 1 < begins.size(); ++i) {
    if (begins[i] + begins[i + 1] > begins[best] + begins[best + 1]) best = i;
  }
  const int together = begins[best] + begins[best + 1];
  // Of two lines, the outer one may show only a part of the film.
  const int at = static_cast<int>(best) + (begins[best] < begins[best + 1] ? 1 : 0);
  Side side;
  side.at = from + at * step;
  const int beside = is_far ? across - 1 - side.at : side.at;
  side.is_border = (is_far ? across - 1 - outside : outside) == 0 && beside <= kStaysWithin_px + 1;
  int changed = 0;
  for (int k = begin; k < begin + length; ++k) {
    const int x = is_column ? side.at : k, y = is_column ? k : side.at;
    const uint8_t* const now = &changed_[static_cast<size_t>(y * stride_ + x)];
    changed += (now[0] | now[inwards]) != 0;
  }
  side.is_straight = together >= kStraight * length && changed >= kStillChanges * together;
  return side;
}

/// Whether what changes is a rectangle that is neither all of the picture nor all between two bars.
/// At most one of its sides may not show, as below a sky.
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

/// The rectangle in which most changes.
std::optional<AreaFinder::Candidate> AreaFinder::best_candidate() {
  std::optional<Candidate> best;
  if (reach_all_borders(cells_, columns_, rows_)) return best;
  for (size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i] < kLineOfCell) continue;
    Candidate candidate;
    if (!grow(i, candidate) || (best && candidate.cells <= best->cells)) continue;
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
  return ++stayed_ >= kStays;
}

/// Of how many sides most of what is beside them reaches `least` in `map`.
int AreaFinder::crossed_sides(const std::vector<uint8_t>& map, uint8_t least) const {
  int crossed = 0;
  for (size_t i = 0; i < sides_.size(); ++i) {
    if (sides_[i].is_border) continue;
    const bool is_column = i < 2;
    const int beside = i % 2 != 0 ? kBeside_px : -kBeside_px;
    const int at = sides_[i].at + beside;
    if (at < 0 || at >= (is_column ? width_ : height_)) continue;
    const int begin = is_column ? area_->y : area_->x;
    const int length = is_column ? area_->height : area_->width;
    int reached = 0;
    for (int k = begin; k < begin + length; ++k) {
      reached += map[static_cast<size_t>(is_column ? k * stride_ + at : at * stride_ + k)] >= least;
    }
    crossed += reached > kMost * length;
  }
  return crossed;
}

void AreaFinder::search(int64_t running_ns) {
  if (area_) searches_from_ = *area_;
  area_.reset();
  stayed_ = 0;
  // What has changed before was elsewhere.
  std::fill(lasting_.begin(), lasting_.end(), uint8_t{0});
  searches_since_ns_ = running_ns;
}

int AreaFinder::lasting_cells(const PicturePart& part) const {
  int count = 0;
  for (int y = part.y + kAreaCell_px / 2; y < part.y + part.height; y += kAreaCell_px) {
    for (int x = part.x + kAreaCell_px / 2; x < part.x + part.width; x += kAreaCell_px) {
      count += lasting_[static_cast<size_t>(y * stride_ + x)] >= kLasts;
    }
  }
  return count;
}

/// What becomes of the area that is known.
void AreaFinder::follow(const std::optional<Candidate>& candidate, bool is_confirmed,
                        int64_t running_ns) {
  if (!candidate || is_same(candidate->part, *area_)) {
    active_ns_ = running_ns;
    return;
  }
  // Of another film, or of a part of this one, while the rest of it still changes.
  const bool is_part = contains(*area_, candidate->part);
  const int others = lasting_cells(candidate->part);
  const int own = lasting_cells(*area_) - (is_part ? others : 0);
  if (contains(candidate->part, *area_) || kPartsThatGoOn * own > others) active_ns_ = running_ns;
  if (is_confirmed && running_ns - active_ns_ >= (is_part ? kSearch_ns : kRests_ns)) {
    settle(*candidate, running_ns);
  }
}

void AreaFinder::settle(const Candidate& candidate, int64_t running_ns) {
  area_ = candidate.part;
  sides_ = candidate.sides;
  active_ns_ = running_ns;
  crossed_ = 0;
  searches_since_ns_.reset();
  is_page_ = false;
}

/// Whether most of what begins at a side changes in the newest picture, and less beside it.
bool AreaFinder::stands(const Side& side, const PicturePart& part, bool is_column,
                        bool is_far) const {
  const int begin = is_column ? part.y : part.x;
  const int length = is_column ? part.height : part.width;
  const int inwards = is_far ? -1 : 1;
  int inside = 0, outside = 0;
  for (int k = begin; k < begin + length; ++k) {
    const auto changes = [&](int at) {
      return changed_[static_cast<size_t>(is_column ? k * stride_ + at : at * stride_ + k)] != 0;
    };
    inside += changes(side.at) || changes(side.at + inwards);
    outside += changes(side.at - kBeside_px * inwards);
  }
  return side.is_straight && inside > kMost * kStraight * length && outside < kMost * inside;
}

void AreaFinder::tell(double across_px, double down_px, int64_t running_ns) {
  if (stayed_ == 1) moved_px_ = {};
  if (stayed_ < 2) return;
  moved_px_[0] += across_px;
  moved_px_[1] += down_px;
  for (size_t axis = 0; axis < 2; ++axis) {
    if (std::abs(moved_px_[axis]) < kMoves_px) continue;
    bool shows = false, moves = false;
    for (size_t i = 2 * axis; i < 2 * axis + 2; ++i) {
      const Side& side = pending_.sides[i];
      if (side.is_border) continue;
      shows = true;
      moves |= !stands(side, pending_.part, axis == 0, i % 2 != 0);
    }
    if (shows && !moves) return settle(pending_, running_ns);
  }
}

void AreaFinder::look(const ImageView& picture, int64_t running_ns, bool scrolls) {
  if (picture.width != width_ || picture.height != height_) {
    begin(picture);
    take(picture);
    std::fill(lasting_.begin(), lasting_.end(), uint8_t{0});
    compared_ = 0;
    return;
  }
  const bool expects = compared_ <= 2 * kStays || searches_since_ns_ || stayed_ > 0 || scrolls_;
  skips_ = !expects && !area_ && !scrolls && !skips_;
  if (skips_) return;
  if (!take(picture) && !scrolls) return;
  const bool has_scrolled = std::exchange(scrolls_, scrolls);
  if (scrolls && has_scrolled) {
    search(running_ns);
    is_page_ = true;
  }
  if (scrolls) return;
  if (area_ && crossed_sides(changed_, 255) > crossed_sides(lasting_, kLasts)) search(running_ns);
  if (area_) {
    crossed_ = crossed_sides(lasting_, kLasts) >= 2 ? crossed_ + 1 : 0;
    if (crossed_ >= kStays) area_.reset();
  }
  const bool is_due = compared_ <= 2 * kStays || searches_since_ns_ || (!area_ && stayed_ > 0);
  if (!is_due && compared_ % kStays != 0) return;
  const std::optional<Candidate> candidate = best_candidate();
  if (!candidate) stayed_ = 0;
  const bool is_confirmed = candidate && confirm(*candidate);
  if (area_) return follow(candidate, is_confirmed, running_ns);
  const int64_t searched_ns = running_ns - searches_since_ns_.value_or(running_ns);
  const bool has_searched = searched_ns >= kSearch_ns;
  // All that moves while a page does is no film.
  const bool may_be_page = searches_since_ns_ && !has_searched && candidate &&
                           candidate->part != searches_from_ &&
                           contains(candidate->part, searches_from_);
  if (is_confirmed && !may_be_page) {
    settle(*candidate, running_ns);
  } else if (searched_ns >= (is_page_ ? kRests_ns : kSearch_ns)) {
    searches_since_ns_.reset();
    is_page_ = false;
  }
}

}  // namespace spidar
