// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// From a picture or a depth image to a relief that can be touched.
#pragma once

#include <cstdint>
#include <vector>

#include "core/api.h"
#include "core/image_view.h"
#include "core/touch/cell_average.h"
#include "core/touch/height_field.h"

namespace spidar {

struct ReliefSettings {
  double floor_z_m = 0;       ///< z of what is black or far; finite
  double relief_m = 0.008;    ///< from there to what is white or near; finite and ≥ 0
  double smoothing_m = 5e-4;  ///< standard deviation of the Gaussian; finite and ≥ 0
};

/// Throws std::invalid_argument that names the value which is out of range.
SPIDAR_API void validate(const ReliefSettings& settings);

/// Builds reliefs. After the first picture of a size nothing is taken from the heap.
///
/// The surface is not steeper than kMaxSlope: along a row or a column never, across a straight edge
/// of another direction to one part in a thousand. What is steeper in the picture keeps its top and
/// gets a slope at its foot: each height becomes the largest of (height of any cell − slope ·
/// distance to it), found in two passes over the picture with the distances of the eight neighbours
/// (G. Borgefors, Distance transformations in digital images, CVGIP 34, 1986).
class SPIDAR_API ReliefBuilder {
 public:
  static constexpr double kMaxSlope = 1.5;
  /// Wider smoothing than this many cells (standard deviation) is bounded to it.
  static constexpr int kMostSmoothing_cells = 5;

  ReliefBuilder();

  /// Bright is near. Returns false, and leaves `field` as it is, when the picture has no pixels.
  /// The settings have to be valid. Cost is that of reading every pixel: hand over a reduced
  /// picture where there is one.
  bool from_brightness(const ImageView& picture, const ReliefSettings& settings,
                       HeightField& field);

  /// From `levels` of HeightField::kCells cells, 0 (far) … 1 (near), as DepthPicture has them. A
  /// hole (NaN) becomes as far as the farther of what is left and right of it, an empty row that of
  /// what is above and below. Returns false, and leaves `field` as it is, when there is nothing but
  /// holes. The settings have to be valid.
  bool from_levels(const float* levels, const ReliefSettings& settings, HeightField& field);

  /// What the smoothing took out of the last picture or depth, as heights about 0: a texture. With
  /// the settings of that picture. Level before the first one.
  void fine_detail(const ReliefSettings& settings, HeightField& field) const noexcept;

 private:
  void finish(const ReliefSettings& settings, HeightField& field) noexcept;
  bool fill_holes() noexcept;
  void smooth(double across_cells, double down_cells) noexcept;

  CellAverage average_;
  std::vector<uint8_t> row_;     // of the picture
  std::vector<float> level_;     // 0 (far) … 1 (near), of each cell, before smoothing
  std::vector<float> smoothed_;  // the same, after
  std::vector<float> passed_;    // after the pass along the rows
};

}  // namespace spidar
