// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/picture/film_area.h"
#include "core/picture/image_view.h"
#include "core/picture/padded_image.h"
#include "core/picture/sharp_sides.h"

namespace spidar {

/// Finds the part of the picture that shows a film. What is around a film, such as a frame, a page
/// or the desktop, does not change, or not with the film. The film is where pixels go on changing,
/// in a rectangle whose sides are straight and stay: along a side, the changes begin at the same
/// column or row. Along the outline of an object, they begin elsewhere in each row, or one picture
/// later at another place. A side at the border of the picture shows nothing. Changes last where
/// there is more than one in kRise + 1 pictures, so that a notification or the noise of one coded
/// picture does not count.
///
/// A rectangle is a film when it has stayed for kStays pictures, or when its content moves and its
/// sides do not: the sides of an object move with the object. Until then, the rectangle is a guess.
/// Where all of the picture changes, the film may lie between blurred copies of itself
/// (SharpSides).
///
/// A film whose camera rests changes only where an object is, and shows no rectangle. A known
/// rectangle is therefore kept until something crosses its sides: another film, or a page that
/// moves. Then the search starts anew, for up to kSearch_ns; if none is found, the film is the
/// whole picture. After a page has scrolled from picture to picture, there is no film until one is
/// found, most of the picture changes, or nothing has scrolled for kRests_ns. A single picture that
/// shows the previous one scrolled is ignored: a film without noise may have such a picture.
///
/// For one thread at a time. Allocates when the size changes, and while something moves in front of
/// a picture at rest.
class AreaFinder {
 public:
  /// Observes the next picture, reduced to 8 bits; a repetition of the previous one changes
  /// nothing. `scrolls` says that it is the previous one, scrolled.
  void observe(const ImageView& picture, int64_t running_ns, bool scrolls = false);

  /// The film in px of the reduced picture; nothing: the film is the whole picture.
  std::optional<PicturePart> area() const {
    if (state_ == State::kFound || state_ == State::kBetweenCopies) return part_;
    return std::nullopt;
  }
  /// Whether the place of the film is unknown: its surroundings move, or have just changed.
  bool is_searching() const {
    return scrolls_ || state_ == State::kSearching || state_ == State::kPage;
  }
  /// The area or, while there is none, a guess at it; nothing: the whole picture.
  std::optional<PicturePart> film() const { return is_guess() ? pending_.part : area(); }
  /// Whether film() is a guess.
  bool is_guess() const { return state_ == State::kWhole && stayed_ > 0 && !scrolls_; }
  /// Observes whether anything in film() moves while that is a guess, and the mean displacement to
  /// the last picture. This may confirm or refute the guess.
  void observe_motion(bool moves, double across_px, double down_px, int64_t running_ns);
  /// Whether the search is in a page.
  bool is_page() const { return scrolls_ || state_ == State::kPage; }

  /// Begins another film.
  void reset() { *this = {}; }

  /// For how many pictures a rectangle must stay before it counts as the film. In this many
  /// pictures, a rectangular object whose texture changes by kChanged_grey a picture moves by more
  /// than a pixel.
  static constexpr int kStays = 4;
  /// How often to look for blurred copies beside the film.
  static constexpr int64_t kCopies_ns = 1'000'000'000;
  static constexpr int64_t kSearch_ns = 1'000'000'000;
  /// How long nothing must change in the film before another one replaces it. A part of the film
  /// that contains all changes replaces it after kSearch_ns.
  static constexpr int64_t kRests_ns = 2'000'000'000;

 private:
  enum class State : uint8_t {
    kWhole,          ///< the film is the whole picture, or perhaps `pending_`
    kFound,          ///< in `part_`
    kBetweenCopies,  ///< in `part_`, beside blurred copies of itself
    kSearching,      ///< the film is unknown, and was in `part_`
    kPage,           ///< the same, in a page that scrolls, or has scrolled
  };
  struct Side {
    int at = 0;             ///< first or last column or row that changes
    bool is_border = true;  ///< of the picture
    bool is_straight = false;
    bool is_left = false;  ///< straight, but nothing has changed there in the newest picture
  };
  struct Candidate {
    PicturePart part;
    std::array<Side, 4> sides;  ///< left, right, top, bottom
    int cells = 0;              ///< that change
  };

  void begin(const ImageView& picture);
  bool compare(const ImageView& picture);
  void store(const ImageView& picture);
  void count_cells();
  bool reach_all_borders() const;
  std::optional<Candidate> best_candidate() const;
  bool has_straight_sides(Candidate& candidate) const;
  Side side_of(const PicturePart& part, bool is_column, bool is_far) const;
  bool confirm(const Candidate& candidate);
  bool stands(const Side& side, const PicturePart& part, bool is_column, bool is_far) const;
  void settle(const Candidate& candidate, int64_t running_ns);
  int crossed_sides(const PaddedImage& map) const;
  void follow(const std::optional<Candidate>& candidate, bool is_confirmed, int64_t running_ns);
  void search(State state, int64_t running_ns);
  void look_for_copies(const ImageView& picture, int64_t running_ns);

  State state_ = State::kWhole;
  PicturePart part_;
  int64_t since_ns_ = 0;  ///< of the search; of a film that is found, when it changed last
  // Maps of the pixels, with whole cells at the right and at the bottom.
  PaddedImage now_, before_;
  PaddedImage changed_;  ///< 255 where the newest picture differs from the one before
  PaddedImage levels_;   ///< see kRise
  PaddedImage lasting_;  ///< 255 where a pixel changes lastingly
  PaddedImage cells_;    ///< 255 where at least a line of a cell changes lastingly
  int width_ = 0;
  int height_ = 0;
  int compared_ = 0;  ///< pictures that have changed
  int lasting_pixels_ = 0;
  size_t skipped_ = 0;    ///< repeated pictures in a row
  int passed_ = 0;        ///< pictures in a row that were not examined
  bool scrolls_ = false;  ///< the newest picture is the one before, scrolled
  Candidate pending_;
  int stayed_ = 0;                    ///< pictures for which `pending_` has stayed
  std::array<double, 2> moved_px_{};  ///< motion of its content since then
  std::array<Side, 4> sides_;         ///< of the film that is found
  int crossed_ = 0;  ///< pictures in which something has lastingly crossed its sides
  SharpSides sharp_sides_;
  std::optional<int64_t> copies_ns_;  ///< when copies were last looked for
  int missed_ = 0;                    ///< searches in a row that found no copies
};

}  // namespace spidar
