// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/height_field.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>

namespace spidar::touch {
namespace {

constexpr int kTaps = 4;

/// A position along an axis: the four surrounding samples, the basis functions that are not zero
/// between the middle two, and their derivatives.
struct Position {
  std::array<int, kTaps> sample;
  std::array<double, kTaps> value;
  std::array<double, kTaps> derivative;

  /// `u` is in samples, with 0 at the first of `count`. Samples outside repeat the border sample.
  Position(double u, int count) noexcept {
    // From two samples outside on, all four are the border sample. The negation also catches NaN.
    if (!(u > -2)) u = -2;
    if (!(u < count + 1)) u = count + 1;
    const double below = std::floor(u);
    const double t = u - below, s = 1 - t;
    value = {s * s * s / 6, (4 - 6 * t * t + 3 * t * t * t) / 6,
             (4 - 6 * s * s + 3 * s * s * s) / 6, t * t * t / 6};
    derivative = {-s * s / 2, (-4 * t + 3 * t * t) / 2, (4 * s - 3 * s * s) / 2, t * t / 2};
    for (int k = 0; k < kTaps; ++k) {
      sample[static_cast<size_t>(k)] = std::clamp(static_cast<int>(below) - 1 + k, 0, count - 1);
    }
  }
};

double require_extent(double extent_m, const char* name) {
  if (std::isfinite(extent_m) && extent_m > 0) return extent_m;
  throw std::invalid_argument("HeightField: " + std::string(name) +
                              " must be finite and above 0, but is " + std::to_string(extent_m));
}

}  // namespace

HeightField::HeightField(double width_m, double height_m)
    : cell_x_m_(require_extent(width_m, "width_m") / kColumns),
      cell_y_m_(require_extent(height_m, "height_m") / kRows),
      z_m_(kCells, 0.0F) {}

SurfacePoint HeightField::at(double x_m, double y_m) const noexcept {
  const Position across(x_m / cell_x_m_ + 0.5 * kColumns - 0.5, kColumns);
  const Position down(0.5 * kRows - 0.5 - y_m / cell_y_m_, kRows);
  double z_m = 0;
  double along_row_m = 0;     // for each sample
  double along_column_m = 0;  // for each sample, downwards
  for (size_t j = 0; j < kTaps; ++j) {
    const float* const samples = row(down.sample[j]);
    double height_m = 0;
    double step_m = 0;
    for (size_t i = 0; i < kTaps; ++i) {
      const double sample_m = static_cast<double>(samples[across.sample[i]]);
      height_m += across.value[i] * sample_m;
      step_m += across.derivative[i] * sample_m;
    }
    z_m += down.value[j] * height_m;
    along_row_m += down.value[j] * step_m;
    along_column_m += down.derivative[j] * height_m;
  }
  return {z_m, {along_row_m / cell_x_m_, -along_column_m / cell_y_m_}};
}

std::string HeightField::shading() const {
  constexpr double kLevel = 128, kMax = 255;
  const Eigen::Vector3d to_light = Eigen::Vector3d(-1, 1, std::sqrt(2.0)).normalized();
  std::string shading(kCells, '\0');
  auto cell = shading.begin();
  for (int y = 0; y < kRows; ++y) {
    const float* const above = row(std::max(y - 1, 0));
    const float* const below = row(std::min(y + 1, kRows - 1));
    for (int x = 0; x < kColumns; ++x) {
      const float left_m = row(y)[std::max(x - 1, 0)];
      const float right_m = row(y)[std::min(x + 1, kColumns - 1)];
      const SurfacePoint point{0,
                               {static_cast<double>(right_m - left_m) / (2 * cell_x_m_),
                                static_cast<double>(above[x] - below[x]) / (2 * cell_y_m_)}};
      const double light = std::max(point.normal().dot(to_light), 0.0);
      const double level = to_light.z();
      const double grey = light < level ? kLevel * light / level
                                        : kLevel + (kMax - kLevel) * (light - level) / (1 - level);
      *cell++ = static_cast<char>(static_cast<uint8_t>(std::lround(std::min(grey, kMax))));
    }
  }
  return shading;
}

}  // namespace spidar::touch
