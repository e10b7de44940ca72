// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/picture/image_view.h"
#include "core/touch/cell_average.h"
#include "core/touch/height_field.h"

namespace spidar::touch {

/// Position of the depth half in the frame of a 2D+Z film.
enum class DepthLayout { kRight, kBelow };

/// Return the visible half and the depth half of a packed picture. With an odd width or height the
/// middle line belongs to neither.
ImageView picture_half(const ImageView& packed, DepthLayout layout) noexcept;
ImageView depth_half(const ImageView& packed, DepthLayout layout) noexcept;

/// What the samples mean: distances, with near < far, or disparities, which grow towards the
/// viewer, with near > far.
struct DepthSettings {
  bool disparity = false;
  /// The sample values of the nearest and the farthest depth, at most 65535; samples outside this
  /// range are clamped to it. An end below 0 is estimated from the pictures.
  double near_sample = -1;
  double far_sample = -1;
  /// Samples of 0, and 16-bit samples of 65535, mean that nothing was measured. Set this to false
  /// for drawn or computed depth, as in 2D+Z films, where these values are the ends of the range.
  bool has_holes = true;
};

/// Throws std::invalid_argument, which names the error: a value that is not finite or is too large,
/// or near and far in the wrong order.
void validate(const DepthSettings& settings);

/// Converts depth samples to a nearness level for each cell of a height field. Allocates only when
/// the size changes. Reads at most four evenly spaced samples per cell, so that the cost does not
/// grow with the size of the picture. Reads 16-bit samples whole, whatever `sample.shift` is.
///
/// An end of the range that is not set is estimated as a percentile of the cells: 2 % of them are
/// nearer than the near end, and 2 % are farther than the far end. Both ends follow the pictures
/// with a time constant of kRange_s, so that the whole relief does not change at once when
/// something passes in front of the camera. The ends jump when more than half of the cells lie
/// outside the range, as after a cut, or when the settings change. The range is at least 8 samples
/// wide, and 1/16 of its larger end, so that noise on a flat wall does not become relief.
class DepthPicture {
 public:
  static constexpr int kSamplesAcross = 2;          ///< per cell in x and in y, at most
  static constexpr double kOutside = 0.02;          ///< fraction of the cells beyond each end
  static constexpr double kRange_s = 1.0;           ///< time constant of the range
  static constexpr double kCut = 0.5;               ///< a larger fraction outside is a cut
  static constexpr double kMinSpan = 8;             ///< least width of the range, samples
  static constexpr double kMinFraction = 1.0 / 16;  ///< least width of the range / larger end

  DepthPicture();

  /// `dt_s` is the time since the last picture; the range adapts only if it is above 0. Returns
  /// false, and keeps the last levels, when the picture has no samples or only holes. The settings
  /// must be valid.
  bool read(const ImageView& depth, const DepthSettings& settings, double dt_s);

  /// Rows of HeightField::kColumns levels from 0 (far) to 1 (near), NaN for a hole. All are holes
  /// before the first picture.
  const float* levels() const noexcept { return levels_.data(); }
  /// The range used for the levels, as sample values. Both are 0 before the first picture.
  double near_sample() const noexcept { return near_; }
  double far_sample() const noexcept { return far_; }

  /// Restarts the estimate of the range, for another film or after a seek.
  void reset() noexcept { has_range_ = false; }

 private:
  bool average(const ImageView& depth, bool has_holes);
  void read_row(const ImageView& depth, int y, bool has_holes, float* values) const noexcept;
  std::pair<double, double> percentiles() noexcept;
  bool is_cut(const DepthSettings& settings) const noexcept;
  void follow(const DepthSettings& settings, double dt_s) noexcept;

  CellAverage average_;
  std::vector<int> column_;   ///< of the picture, for each column that is read
  std::vector<float> cells_;  ///< mean sample
  std::vector<float> levels_;
  std::vector<float> sorted_;  ///< cells_ without the holes, partly sorted
  int read_width_ = 0;         ///< number of columns that are read
  int from_width_ = 0;         ///< width of the picture
  DepthSettings settings_;     ///< used for the current range
  double near_ = 0;
  double far_ = 0;
  bool has_range_ = false;
};

}  // namespace spidar::touch
