// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <vector>

#include "core/picture/image_view.h"
#include "core/touch/cell_average.h"
#include "core/touch/height_field.h"

namespace spidar::touch {

struct ReliefSettings {
  double floor_z_m = 0;       ///< z of black or farthest; finite
  double relief_m = 0.008;    ///< height of white or nearest above floor_z_m; finite and ≥ 0
  double smoothing_m = 5e-4;  ///< standard deviation of the Gaussian filter; finite and ≥ 0
  double black_grey = 0;      ///< brightness of black
  double white_grey = 255;    ///< brightness of white, larger; 16 and 235 in most films
};

/// Throws std::invalid_argument, which names the value that is out of range.
void validate(const ReliefSettings& settings);

/// Builds reliefs. Allocates only when the size of the picture changes.
///
/// The slope of the surface is limited to kMaxSlope: exactly along rows and columns, and within one
/// part in a thousand across a straight edge in any other direction. A steeper edge keeps its top
/// and gets a ramp at its foot: the new height of a cell is the maximum, over all cells, of their
/// height − slope · distance. Two passes over the picture with the distances of the eight
/// neighbours find that maximum (G. Borgefors, Distance transformations in digital images, CVGIP
/// 34, 1986).
class ReliefBuilder {
 public:
  static constexpr double kMaxSlope = 1.5;
  /// The standard deviation of the smoothing is limited to this many cells.
  static constexpr int kMaxSmoothing_cells = 5;

  ReliefBuilder();

  /// Builds a relief in which bright is near. Returns false, and leaves `field` unchanged, when the
  /// picture has no pixels. The settings must be valid. Reads every pixel, so pass a reduced
  /// picture if one is available.
  bool from_brightness(const ImageView& picture, const ReliefSettings& settings,
                       HeightField& field);

  /// Builds a relief from the `levels` of HeightField::kCells cells, 0 (far) … 1 (near), as
  /// DepthPicture provides them. A hole (NaN) takes the farther of the values to its left and right
  /// or, in a row of holes alone, of those above and below. Returns false, and leaves `field`
  /// unchanged, when all cells are holes. The settings must be valid.
  bool from_levels(const float* levels, const ReliefSettings& settings, HeightField& field);

  /// Writes the detail that smoothing removed from the last picture or depth, as heights about 0 (a
  /// texture). Expects the settings used for that picture. All 0 before the first one.
  void fine_detail(const ReliefSettings& settings, HeightField& field) const noexcept;

 private:
  void finish(const ReliefSettings& settings, HeightField& field) noexcept;
  bool fill_holes() noexcept;
  void smooth(double across_cells, double down_cells) noexcept;

  CellAverage average_;
  std::vector<uint8_t> row_;     ///< of the picture
  std::vector<float> level_;     ///< 0 (far) … 1 (near), of each cell, before smoothing
  std::vector<float> smoothed_;  ///< level_ after smoothing
  std::vector<float> passed_;    ///< level_ after smoothing along the rows
};

}  // namespace spidar::touch
