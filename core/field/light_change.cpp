// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/light_change.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace spidar {
namespace {

/// If more than this fraction of the difference is left, the gain may be chance. Where the camera
/// pans, most of the difference is motion, whatever the light does.
constexpr double kAlike = 0.9;

/// Mean brightness of two pictures of the same size, grey levels, and the ratio of their contrasts.
struct LightChange {
  double mean_before = 0;
  double mean_now = 0;
  double gain = 1;
};

void mean_and_variance(const PaddedImage& picture, double& mean, double& variance) {
  int64_t sum = 0;
  int64_t squares = 0;
  for (int y = 0; y < picture.height(); ++y) {
    const uint8_t* row = picture.row(y);
    int row_sum = 0;
    int row_squares = 0;
    for (int x = 0; x < picture.width(); ++x) {
      row_sum += row[x];
      row_squares += row[x] * row[x];
    }
    sum += row_sum;
    squares += row_squares;
  }
  const auto n = static_cast<double>(picture.width()) * picture.height();
  mean = static_cast<double>(sum) / n;
  variance = static_cast<double>(squares) / n - mean * mean;
}

LightChange light_change(const PaddedImage& before, const PaddedImage& now) {
  LightChange change;
  double variance_before = 0;
  double variance_now = 0;
  mean_and_variance(before, change.mean_before, variance_before);
  mean_and_variance(now, change.mean_now, variance_now);
  // Contrast below one grey level is mostly rounding error.
  if (variance_before >= 1 && variance_now >= 1) {
    change.gain = std::sqrt(variance_now / variance_before);
  }
  return change;
}

/// Whether replacing the values of `before` makes it clearly more like `now`.
bool makes_alike(const PaddedImage& before, const PaddedImage& now,
                 const std::array<uint8_t, 256>& table) {
  int64_t as_it_was = 0;
  int64_t replaced = 0;
  for (int y = 0; y < now.height(); ++y) {
    const uint8_t* p = before.row(y);
    const uint8_t* q = now.row(y);
    for (int x = 0; x < now.width(); ++x) {
      as_it_was += std::abs(q[x] - p[x]);
      replaced += std::abs(q[x] - table[p[x]]);
    }
  }
  return static_cast<double>(replaced) < kAlike * static_cast<double>(as_it_was);
}

void replace_values(const std::array<uint8_t, 256>& table, PaddedImage& picture) {
  for (int y = 0; y < picture.height(); ++y) {
    uint8_t* row = picture.row(y);
    for (int x = 0; x < picture.width(); ++x) row[x] = table[row[x]];
  }
  picture.repeat_border();
}

}  // namespace

void compensate_light(PaddedImage& coarse_before, const PaddedImage& coarse_now,
                      PaddedImage& before) {
  const LightChange change = light_change(coarse_before, coarse_now);
  std::array<uint8_t, 256> table;
  for (size_t v = 0; v < table.size(); ++v) {
    const double value = change.gain * (static_cast<double>(v) - change.mean_before);
    table[v] = static_cast<uint8_t>(std::clamp(value + change.mean_now + 0.5, 0.0, 255.0));
  }
  if (!makes_alike(coarse_before, coarse_now, table)) return;
  replace_values(table, coarse_before);
  replace_values(table, before);
}

}  // namespace spidar
