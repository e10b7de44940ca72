// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Pictures of a screen on which a film has only a part.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "core/picture/picture_part.h"
#include "tests/support/texture.h"

namespace spidar::test::screen {

/// A reduced picture.
inline constexpr int kWidth = 427, kHeight = 240;
inline constexpr int kRate = 25;
inline constexpr int64_t kPicture_ns = 1'000'000'000 / kRate;

using Part = PicturePart;
/// Grey level of picture n at a position, px from the upper left corner of what it is about.
using Scene = std::function<double(int n, double x, double y)>;

/// A texture with linear interpolation between pixels, which takes a tenth of the time.
class Sheet {
 public:
  Sheet(uint32_t seed, double cell_px) {
    const Texture texture(seed, cell_px);
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) grey_.push_back(static_cast<float>(texture.at(x, y)));
    }
  }
  double at(double x, double y) const {
    const double left = std::floor(x), top = std::floor(y), right = x - left, down = y - top;
    const auto grey = [&](int across, int below) -> double {
      const auto column = static_cast<size_t>(static_cast<int>(left) + across) % kSide;
      const auto row = static_cast<size_t>(static_cast<int>(top) + below) % kSide;
      return grey_[row * kSide + column];
    };
    return (1 - down) * ((1 - right) * grey(0, 0) + right * grey(1, 0)) +
           down * ((1 - right) * grey(0, 1) + right * grey(1, 1));
  }

 private:
  static constexpr int kSide = 512;  // a power of 2: negative positions repeat it, too
  std::vector<float> grey_;
};

inline const Sheet kWall(1, 10), kThing(2, 8), kPage(3, 4), kOther(4, 9);

inline bool is_in(const Part& part, double x, double y) {
  return x >= part.x && y >= part.y && x < part.x + part.width && y < part.y + part.height;
}

inline double pan(int n, double x, double y) {
  return kWall.at(x + 2.2 * n, y + 0.7 * n);
}

/// A camera at rest, and a disc that goes around.
inline double disc(int n, double x, double y) {
  const double at_x = 100 + 50 * std::cos(0.1 * n), at_y = 70 + 30 * std::sin(0.1 * n);
  if (std::hypot(x - at_x, y - at_y) < 25) return kThing.at(x - at_x, y - at_y);
  return kWall.at(x, y);
}

/// Lines of words.
inline double page(int, double x, double y) {
  if (std::fmod(y + 1000, 8) < 3 || std::fmod(x + 1000, 37) < 4) return 240;
  return kPage.at(x, y) > 128 ? 40 : 240;
}

inline Scene at_rest(const Scene& scene) {
  return [=](int, double x, double y) { return scene(0, x, y); };
}

/// `film` in `part` of `around`.
inline Scene within(const Scene& around, const Part& part, const Scene& film) {
  return [=](int n, double x, double y) {
    return is_in(part, x, y) ? film(n, x - part.x, y - part.y) : around(n, x, y);
  };
}

/// `later` from picture `n` on.
inline Scene then(int n, const Scene& first, const Scene& later) {
  return [=](int now, double x, double y) { return now < n ? first(now, x, y) : later(now, x, y); };
}

inline Scene moved(const Scene& scene, const std::function<double(int n)>& down) {
  return [=](int n, double x, double y) { return scene(n, x, y - down(n)); };
}

/// The sides of such an object are straight, but do not stay.
inline Scene square(double speed, double across, double down) {
  return [=](int n, double x, double y) {
    const double at_x = 60 + speed * across * n, at_y = 80 + speed * down * n;
    const bool is_inside = std::abs(x - at_x - 60) < 60 && std::abs(y - at_y - 45) < 45;
    return is_inside ? kThing.at(x - at_x, y - at_y) : kWall.at(x, y);
  };
}

inline constexpr std::pair<double, double> kDirections[] = {{1.0, 0.0}, {0.7, 0.7}, {0.0, -0.5}};

/// A disc before a camera that pans.
inline double disc_before_a_pan(int n, double x, double y) {
  const double at_x = 100 + 50 * std::cos(0.1 * n), at_y = 70 + 30 * std::sin(0.1 * n);
  if (std::hypot(x - at_x, y - at_y) < 25) return kThing.at(x - at_x, y - at_y);
  return pan(n, x, y);
}

/// The part of a page in which most films are.
inline constexpr Part kMiddle{90, 50, 240, 135};

}  // namespace spidar::test::screen
