// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace spidar::touch {

struct SurfacePoint {
  double z_m = 0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< dz/dx and dz/dy, without a unit

  /// Unit normal, towards the viewer.
  Eigen::Vector3d normal() const noexcept {
    return Eigen::Vector3d(-slope.x(), -slope.y(), 1) / std::sqrt(1 + slope.squaredNorm());
  }
};

/// A smooth height field: heights z in the device frame, over a picture whose centre is the
/// device's origin. Columns run from left (−x) to right, rows from the top (+y) down. A sample lies
/// at the centre of its cell.
///
/// The surface is the uniform cubic B-spline with the samples as its coefficients (C. de Boor, A
/// Practical Guide to Splines). Its height, slope and curvature are continuous. The surface smooths
/// the samples and does not pass through them. It is never above the highest sample or below the
/// lowest one, and dz/dx is never steeper than the steepest step between two neighbours of a row
/// (dz/dy: of a column). A plane is reproduced exactly; elsewhere the surface differs from the
/// samples by cell²/6 · d²z/dx², and likewise in y. Outside the picture, the border heights
/// continue with zero slope across the border.
class HeightField {
 public:
  static constexpr int kColumns = 256;
  static constexpr int kRows = 144;
  static constexpr int kCells = kColumns * kRows;

  /// All heights start at 0. The picture measures `width_m` × `height_m` in the device frame.
  /// Throws std::invalid_argument unless both are finite and above 0. No other function allocates.
  HeightField(double width_m, double height_m);

  float* row(int y) noexcept { return z_m_.data() + y * kColumns; }
  const float* row(int y) const noexcept { return z_m_.data() + y * kColumns; }

  double width_m() const noexcept { return kColumns * cell_x_m_; }
  double height_m() const noexcept { return kRows * cell_y_m_; }
  double cell_x_m() const noexcept { return cell_x_m_; }
  double cell_y_m() const noexcept { return cell_y_m_; }
  /// Coordinates of the sample in column `x` and row `y`.
  double x_m(int x) const noexcept { return (x + 0.5 - 0.5 * kColumns) * cell_x_m_; }
  double y_m(int y) const noexcept { return (0.5 * kRows - 0.5 - y) * cell_y_m_; }

  /// Evaluates the surface at a position in the device frame. NaN means the left or upper border.
  SurfacePoint at(double x_m, double y_m) const noexcept;

  /// A picture of the relief for the eye: the brightness of each cell, rows from the top, as on
  /// maps with hill shading. The light comes from the upper left, 45° above the picture: 128 is
  /// level, 255 faces the light, and 0 is turned away by a right angle.
  std::string shading() const;

 private:
  double cell_x_m_;
  double cell_y_m_;
  std::vector<float> z_m_;  ///< rows of kColumns
};

}  // namespace spidar::touch
