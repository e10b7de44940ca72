// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds the film in pictures that show something else around it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/picture/film_area.h"
#include "core/picture/image_view.h"

namespace spidar {

/// What is around a film does not change, or not with it: a frame, a page, the desktop. The film is
/// where pixels go on changing, in a rectangle whose sides are straight and stay: along a side,
/// what changes begins at the same column or row, where the outline of an object would have it
/// begin elsewhere in each row, or one picture later at another place. A side at the border of the
/// picture says nothing. Changes last where they are more than one in kRise + 1 pictures, so that a
/// notification or the noise of one coded picture does not count.
///
/// A rectangle is a film when it has stayed for kStays pictures, or when what is in it moves and
/// its sides do not: those of an object move with it. Until then, the film is all of the picture.
///
/// A film whose camera rests changes only where an object is, and shows no rectangle. A known one
/// is therefore kept until something crosses its sides: another film, or a page that moves. Then
/// the film is looked for anew, for up to kSearch_ns; if none is found, it is all of the picture.
/// After a page has scrolled from picture to picture, there is no film until one is found, most of
/// the picture changes, or nothing has scrolled for kRests_ns. A single picture that is the one
/// before, scrolled, is left out: a film without noise may have it.
///
/// For one thread at a time. Allocates only when the size changes.
class AreaFinder {
 public:
  /// Takes the next picture, reduced to 8 bits; one that shows the previous one again changes
  /// nothing. `scrolls`: it is the previous one, scrolled.
  void look(const ImageView& picture, int64_t running_ns, bool scrolls = false);

  /// Px of the reduced picture; nothing: the film is all of it.
  const std::optional<PicturePart>& area() const { return area_; }
  /// It is not known where the film is: what is around it moves, or has just changed.
  bool is_searching() const { return scrolls_ || searches_since_ns_.has_value(); }
  /// What may be the film, while all of the picture is taken for it.
  std::optional<PicturePart> candidate() const {
    if (area_ || is_searching() || stayed_ == 0) return {};
    return pending_.part;
  }
  /// How far what is in candidate() has moved to the picture that was looked at last. That may show
  /// that it is the film.
  void tell(double across_px, double down_px, int64_t running_ns);
  /// It searches in a page.
  bool is_page() const { return is_page_ || scrolls_; }

  /// Another film begins.
  void reset() {
    width_ = 0;
    area_.reset();
    searches_since_ns_.reset();
    is_page_ = scrolls_ = false;
  }

  /// How many pictures a rectangle must stay before it is believed. An object that is a rectangle
  /// with a texture that changes by kChanged_grey a picture moves by more than a pixel in them.
  static constexpr int kStays = 4;
  static constexpr int64_t kSearch_ns = 1'000'000'000;
  /// For how long nothing must change in the film before another one replaces it; a part of it,
  /// with all that changes in it, does after kSearch_ns.
  static constexpr int64_t kRests_ns = 2'000'000'000;

 private:
  struct Side {
    int at = 0;             ///< first or last column or row that changes
    bool is_border = true;  ///< of the picture
    bool is_straight = false;
  };
  struct Candidate {
    PicturePart part;
    std::array<Side, 4> sides;  ///< left, right, top, bottom
    int cells = 0;              ///< that change
  };

  void begin(const ImageView& picture);
  bool take(const ImageView& picture);
  std::optional<Candidate> best_candidate();
  bool grow(size_t cell, Candidate& candidate);
  bool has_straight_sides(Candidate& candidate) const;
  Side side_of(const PicturePart& part, bool is_column, bool is_far) const;
  bool confirm(const Candidate& candidate);
  bool stands(const Side& side, const PicturePart& part, bool is_column, bool is_far) const;
  void settle(const Candidate& candidate, int64_t running_ns);
  int crossed_sides(const std::vector<uint8_t>& map, uint8_t least) const;
  void follow(const std::optional<Candidate>& candidate, bool is_confirmed, int64_t running_ns);
  int lasting_cells(const PicturePart& part) const;
  void search(int64_t running_ns);

  int width_ = 0;
  int height_ = 0;
  int stride_ = 0;  ///< of the maps below, a multiple of 16
  std::vector<uint8_t> before_;
  std::vector<uint8_t> changed_;  ///< 255 where the newest picture differs from the one before
  std::vector<uint8_t> lasting_;  ///< how lastingly a pixel changes
  int compared_ = 0;              ///< pictures that have changed
  int lasting_pixels_ = 0;
  size_t skipped_ = 0;  ///< repeated pictures in a row
  bool skips_ = false;  ///< the last picture was not looked at
  bool is_page_ = false;
  bool scrolls_ = false;  ///< the newest picture is the one before, scrolled
  int columns_ = 0;
  int rows_ = 0;
  std::vector<uint8_t> cells_;  ///< number of lasting pixels in each
  std::vector<size_t> open_;    ///< cells that wait in grow()
  Candidate pending_;
  int stayed_ = 0;                    ///< pictures in which it has been `pending_`
  std::array<double, 2> moved_px_{};  ///< what is in it, since then
  std::optional<PicturePart> area_;
  std::array<Side, 4> sides_;  ///< of `area_`
  int crossed_ = 0;            ///< pictures in which something has lastingly crossed its sides
  int64_t active_ns_ = 0;      ///< when the film changed last
  std::optional<int64_t> searches_since_ns_;
  PicturePart searches_from_;  ///< where the film was
};

}  // namespace spidar
