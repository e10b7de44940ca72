// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/support/spline_sheet.h"

#include <array>
#include <cmath>

#include "tests/support/bspline.h"

namespace spidar::test {
namespace {

int power_of_two(double least) {
  int n = 8;
  while (n < least) n *= 2;
  return n;
}

/// A coordinate as its cell and the weights of the four control values about it.
struct Cell {
  explicit Cell(double u)
      : first(static_cast<int>(std::floor(u)) - 1),
        weights(bspline_weights(static_cast<float>(u - std::floor(u)))) {}
  int first;
  std::array<float, 4> weights;
};

}  // namespace

SplineSheet::SplineSheet(double width_px, double height_px)
    : columns_(power_of_two(width_px / kSpacing_px)),
      rows_(power_of_two(height_px / kSpacing_px)),
      values_(static_cast<size_t>(columns_) * static_cast<size_t>(rows_)) {}

float SplineSheet::at(double u, double v) const {
  const Cell x(u);
  const Cell y(v);
  float sum = 0;
  for (int b = 0; b < 4; ++b) {
    float row = 0;
    for (int a = 0; a < 4; ++a) {
      row += x.weights[static_cast<size_t>(a)] * control(x.first + a, y.first + b);
    }
    sum += y.weights[static_cast<size_t>(b)] * row;
  }
  return sum;
}

/// The rows come first, because all pixels share them; then the columns, which every second pixel
/// shares.
void SplineSheet::pixel_line(const Eigen::Vector2d& start_px, int count, float* grey) const {
  const double u = start_px.x() / kSpacing_px;
  const Cell y(start_px.y() / kSpacing_px);
  const int first = static_cast<int>(std::floor(u)) - 1;
  std::vector<float> sums(static_cast<size_t>(count) / 2 + 6);
  for (int b = 0; b < 4; ++b) {
    const float weight = y.weights[static_cast<size_t>(b)];
    for (size_t k = 0; k < sums.size(); ++k) {
      sums[k] += weight * control(first + static_cast<int>(k), y.first + b);
    }
  }
  for (int phase = 0; phase < 2; ++phase) {
    const Cell x(u + phase / kSpacing_px);
    const float* from = sums.data() + (x.first - first);
    for (int k = phase; k < count; k += 2, ++from) {
      grey[k] = x.weights[0] * from[0] + x.weights[1] * from[1] + x.weights[2] * from[2] +
                x.weights[3] * from[3];
    }
  }
}

void SplineSheet::line(const Eigen::Vector2d& start_px, const Eigen::Vector2d& step_px, int count,
                       float* grey) const {
  if (step_px == Eigen::Vector2d(1, 0)) return pixel_line(start_px, count, grey);
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector2d at_px = start_px + k * step_px;
    grey[k] = at(at_px.x() / kSpacing_px, at_px.y() / kSpacing_px);
  }
}

}  // namespace spidar::test
