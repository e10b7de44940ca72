// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "core/picture/picture_part.h"

namespace spidar {

/// Which part of the pictures is analysed, where something else is around the film.
struct AreaSetting {
  enum class Kind : uint8_t {
    kWhole,
    kAuto,       ///< the part that AreaFinder finds
    kFixed,      ///< `part`
    kFractions,  ///< `fractions`
  };

  Kind kind = Kind::kAuto;
  // What is outside the picture is left out.
  PicturePart part;                   ///< px
  std::array<double, 4> fractions{};  ///< of the picture: x, y, width, height

  /// Returns the part to analyse of a picture of this size: the whole picture with kWhole and
  /// kAuto. A part with a side below kMinSide_px cannot be analysed.
  PicturePart of_picture(int width, int height) const {
    if (kind == Kind::kFractions) {
      const auto [x, y, part_width, part_height] = fractions;
      const auto px = [](double fraction, int side) {
        return static_cast<int>(std::lround(std::clamp(fraction, 0.0, 1.0) * side));
      };
      const int left = px(x, width), top = px(y, height);
      return {left, top, px(x + part_width, width) - left, px(y + part_height, height) - top};
    }
    if (kind != Kind::kFixed) return {0, 0, width, height};
    const int left = std::clamp(part.x, 0, width), top = std::clamp(part.y, 0, height);
    // The sums may be too large for an int.
    const int right = part.width < width - part.x ? part.x + part.width : width;
    const int bottom = part.height < height - part.y ? part.y + part.height : height;
    return {left, top, std::max(right - left, 0), std::max(bottom - top, 0)};
  }
};

/// Where a film is in its picture, px.
struct FilmPlace {
  PicturePart area;
  int picture_width = 0;
  int picture_height = 0;
  bool is_known = true;  ///< false while AreaFinder searches: nothing is measured
  bool is_page = false;  ///< whether the search is in a page that has scrolled

  static FilmPlace whole(int width, int height) { return {{0, 0, width, height}, width, height}; }

  bool operator==(const FilmPlace& other) const {
    return area == other.area && picture_width == other.picture_width &&
           picture_height == other.picture_height && is_known == other.is_known &&
           is_page == other.is_page;
  }
  /// Converts a position in the picture, where (0, 0) is the top left corner and (1, 1) the bottom
  /// right one, to px from the middle of the film.
  Eigen::Vector2d film_px(const Eigen::Vector2d& position) const {
    return {position.x() * picture_width - area.x - 0.5 * area.width,
            position.y() * picture_height - area.y - 0.5 * area.height};
  }
};

}  // namespace spidar
