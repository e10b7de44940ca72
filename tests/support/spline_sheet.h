// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace spidar::test {

/// A picture that is also defined between its pixels, fast enough for films: grey levels by a cubic
/// B-spline over a grid of control values, which repeats in both directions.
///
/// The picture is the spline itself, not an interpolation between samples, so it can be moved by
/// any fraction of a pixel without error. Drawn at scale 1, its spectrum is that of the control
/// values times sinc⁴(2 f), which is zero at the Nyquist frequency f = 1/2 and below 0.3 % beyond
/// it: an edge in the control values becomes one of about 3 px, and nothing aliases.
class SplineSheet {
 public:
  /// Pixels from one control value to the next.
  static constexpr double kSpacing_px = 2;

  /// At least `width_px` × `height_px` before it repeats; the control values are 0.
  SplineSheet(double width_px, double height_px);

  /// Control values; both numbers are powers of two.
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Repeats for any i and j.
  float& control(int i, int j) { return values_[index(i, j)]; }
  float control(int i, int j) const { return values_[index(i, j)]; }

  /// Sets each control value to grey(x, y), 0 … 255, at its position in pixels; (0, 0) is the
  /// middle of the part that is not a repetition.
  template <typename Grey>
  void fill(Grey&& grey) {
    for (int j = -rows_ / 2; j < rows_ / 2; ++j) {
      for (int i = -columns_ / 2; i < columns_ / 2; ++i) {
        control(i, j) = static_cast<float>(grey(i * kSpacing_px, j * kSpacing_px));
      }
    }
  }

  /// `count` grey levels at start, start + step, start + 2 step, …; fast for step (1, 0).
  void line(const Eigen::Vector2d& start_px, const Eigen::Vector2d& step_px, int count,
            float* grey) const;

 private:
  size_t index(int i, int j) const {
    return static_cast<size_t>(j & (rows_ - 1)) * static_cast<size_t>(columns_) +
           static_cast<size_t>(i & (columns_ - 1));
  }
  void pixel_line(const Eigen::Vector2d& start_px, int count, float* grey) const;
  float at(double u, double v) const;

  int columns_;
  int rows_;
  std::vector<float> values_;
};

}  // namespace spidar::test
