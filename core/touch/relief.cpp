// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/touch/relief.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/picture/luma.h"
#include "core/require.h"

namespace spidar::touch {
namespace {

constexpr int kColumns = HeightField::kColumns;
constexpr int kRows = HeightField::kRows;

bool finite_and_not_negative(double value) {
  return std::isfinite(value) && value >= 0;
}

/// Gaussian kernel truncated at three standard deviations and normalized to a sum of 1.
class Kernel {
 public:
  static constexpr int kMaxRadius = 3 * ReliefBuilder::kMaxSmoothing_cells;

  explicit Kernel(double sigma_cells) noexcept {
    const double sigma =
        std::min(sigma_cells, static_cast<double>(ReliefBuilder::kMaxSmoothing_cells));
    radius = static_cast<int>(std::ceil(3 * sigma));
    double sum = 0;
    for (int k = -radius; k <= radius; ++k) sum += gaussian(k, sigma);
    for (int k = -radius; k <= radius; ++k) {
      weight[static_cast<size_t>(k + radius)] = static_cast<float>(gaussian(k, sigma) / sum);
    }
  }

  int radius;
  std::array<float, 2 * kMaxRadius + 1> weight;

 private:
  static double gaussian(int k, double sigma) noexcept {
    return sigma > 0 ? std::exp(-0.5 * k * k / (sigma * sigma)) : 1;
  }
};

/// The lower of two levels; NaN is ignored.
float farther(float a, float b) noexcept {
  return std::fmin(a, b);
}

/// Fills NaN among `count` samples, `step` apart, from the nearest valid samples before and after.
void fill_line(float* line, int count, int step) noexcept {
  float before = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < count;) {
    if (!std::isnan(line[i * step])) {
      before = line[i * step];
      ++i;
      continue;
    }
    int end = i;
    while (end < count && std::isnan(line[end * step])) ++end;
    const float fill = farther(before, end < count ? line[end * step] : before);
    for (; i < end; ++i) line[i * step] = fill;
  }
}

void limit_slope(HeightField& field) noexcept {
  // Distances over eight neighbours turn a circle into an octagon. With square cells its flanks are
  // steeper than along an axis by 1 / cos(22.5°). The slope is reduced by that factor, so along an
  // axis it is slightly flatter than allowed.
  const double slope = ReliefBuilder::kMaxSlope * std::cos(M_PI / 8);
  const double x_m = slope * field.cell_x_m(), y_m = slope * field.cell_y_m();
  const auto across_m = static_cast<float>(x_m), down_m = static_cast<float>(y_m);
  const auto diagonal_m = static_cast<float>(std::hypot(x_m, y_m));
  // One row of one of the two passes: raises row `y` to the envelope of the neighbour row `from`
  // and of the preceding cells in the direction `step`.
  const auto sweep = [&](int y, int from, int step) {
    float* const row = field.row(y);
    if (from >= 0 && from < kRows) {
      const float* const other = field.row(from);
      for (int x = 0; x < kColumns; ++x) row[x] = std::max(row[x], other[x] - down_m);
      for (int x = 1; x < kColumns; ++x) row[x] = std::max(row[x], other[x - 1] - diagonal_m);
      for (int x = 0; x + 1 < kColumns; ++x) row[x] = std::max(row[x], other[x + 1] - diagonal_m);
    }
    const int first = step > 0 ? 0 : kColumns - 1;
    float last = row[first];
    for (int k = 1; k < kColumns; ++k) {
      float& z = row[first + k * step];
      last = std::max(z, last - across_m);
      z = last;
    }
  };
  for (int y = 0; y < kRows; ++y) sweep(y, y - 1, 1);
  for (int y = kRows - 1; y >= 0; --y) sweep(y, y + 1, -1);
}

}  // namespace

void validate(const ReliefSettings& settings) {
  require(std::isfinite(settings.floor_z_m), "Relief", "floor_z_m", "finite", settings.floor_z_m);
  require(finite_and_not_negative(settings.relief_m), "Relief", "relief_m", "finite and ≥ 0",
          settings.relief_m);
  require(finite_and_not_negative(settings.smoothing_m), "Relief", "smoothing_m", "finite and ≥ 0",
          settings.smoothing_m);
}

ReliefBuilder::ReliefBuilder()
    : level_(HeightField::kCells, 0.0F),
      smoothed_(HeightField::kCells, 0.0F),
      passed_(HeightField::kCells, 0.0F) {}

bool ReliefBuilder::from_brightness(const ImageView& picture, const ReliefSettings& settings,
                                    HeightField& field) {
  if (picture.data == nullptr || picture.width <= 0 || picture.height <= 0) return false;
  row_.resize(static_cast<size_t>(picture.width));
  std::array<float, 256> level_of;
  for (size_t grey = 0; grey < level_of.size(); ++grey) {
    const double level = (static_cast<double>(grey) - settings.black_grey) /
                         (settings.white_grey - settings.black_grey);
    level_of[grey] = static_cast<float>(std::clamp(level, 0.0, 1.0));
  }
  average_.read(
      picture.width, picture.height,
      [&](int y, float* values) {
        copy_row(picture, 0, y, picture.width, row_.data());
        for (int x = 0; x < picture.width; ++x) {
          values[x] = level_of[row_[static_cast<size_t>(x)]];
        }
      },
      level_.data());
  finish(settings, field);
  return true;
}

bool ReliefBuilder::from_levels(const float* levels, const ReliefSettings& settings,
                                HeightField& field) {
  std::copy_n(levels, HeightField::kCells, level_.begin());
  if (!fill_holes()) return false;
  finish(settings, field);
  return true;
}

bool ReliefBuilder::fill_holes() noexcept {
  for (int y = 0; y < kRows; ++y) fill_line(level_.data() + y * kColumns, kColumns, 1);
  // Only rows without any valid sample are still NaN.
  for (int x = 0; x < kColumns; ++x) fill_line(level_.data() + x, kRows, kColumns);
  return !std::isnan(level_[0]);
}

void ReliefBuilder::smooth(double across_cells, double down_cells) noexcept {
  const Kernel across(across_cells);
  std::array<float, kColumns + 2 * Kernel::kMaxRadius> padded;
  for (int y = 0; y < kRows; ++y) {
    const float* const from = level_.data() + y * kColumns;
    float* const to = passed_.data() + y * kColumns;
    std::fill_n(padded.begin(), across.radius, from[0]);
    std::copy_n(from, kColumns, padded.begin() + across.radius);
    std::fill_n(padded.begin() + across.radius + kColumns, across.radius, from[kColumns - 1]);
    std::fill_n(to, kColumns, 0.0F);
    for (int k = 0; k <= 2 * across.radius; ++k) {
      const float weight = across.weight[static_cast<size_t>(k)];
      const float* const shifted = padded.data() + k;
      for (int x = 0; x < kColumns; ++x) to[x] += weight * shifted[x];
    }
  }
  const Kernel down(down_cells);
  for (int y = 0; y < kRows; ++y) {
    float* const to = smoothed_.data() + y * kColumns;
    std::fill_n(to, kColumns, 0.0F);
    for (int k = -down.radius; k <= down.radius; ++k) {
      const float weight = down.weight[static_cast<size_t>(k + down.radius)];
      const float* const from = passed_.data() + std::clamp(y + k, 0, kRows - 1) * kColumns;
      for (int x = 0; x < kColumns; ++x) to[x] += weight * from[x];
    }
  }
}

void ReliefBuilder::finish(const ReliefSettings& settings, HeightField& field) noexcept {
  smooth(settings.smoothing_m / field.cell_x_m(), settings.smoothing_m / field.cell_y_m());
  const auto floor_m = static_cast<float>(settings.floor_z_m);
  const auto relief_m = static_cast<float>(settings.relief_m);
  for (int i = 0; i < HeightField::kCells; ++i) {
    field.row(0)[i] = floor_m + relief_m * smoothed_[static_cast<size_t>(i)];
  }
  limit_slope(field);
}

void ReliefBuilder::fine_detail(const ReliefSettings& settings, HeightField& field) const noexcept {
  const auto relief_m = static_cast<float>(settings.relief_m);
  for (size_t i = 0; i < static_cast<size_t>(HeightField::kCells); ++i) {
    field.row(0)[i] = relief_m * (level_[i] - smoothed_[i]);
  }
}

}  // namespace spidar::touch
