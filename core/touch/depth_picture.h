// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// From samples of depth to how near each cell of a height field is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/api.h"
#include "core/image_view.h"
#include "core/touch/cell_average.h"
#include "core/touch/height_field.h"

namespace spidar {

/// Depth, `height` rows of `width` samples of one or two bytes, rows `stride_bytes` apart. Never
/// owns the memory.
struct DepthView {
  const uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  ptrdiff_t stride_bytes = 0;
  int bytes = 1;            ///< of a sample: 1 or 2; a word need not lie at an even address
  bool big_endian = false;  ///< of words
  /// Samples of 0, and words of 65535, say that nothing was measured there. Not so where depth was
  /// drawn or computed, as in 2D+Z films: there they are the ends of the range.
  bool has_holes = true;
};

/// Where in its picture a 2D+Z film has the depth: each takes half.
enum class DepthLayout { kRight, kBelow };

/// The half of a packed picture that is seen, and the half that is depth. Of an odd width or height
/// the line in the middle belongs to neither. Words keep all of their bits, whatever `sample.shift`
/// says.
SPIDAR_API ImageView picture_half(const ImageView& packed, DepthLayout layout) noexcept;
SPIDAR_API DepthView depth_half(const ImageView& packed, DepthLayout layout) noexcept;

/// What samples mean. A distance has near < far; of a disparity, which is larger where it is
/// nearer, near > far.
struct DepthSettings {
  bool disparity = false;
  /// The samples that stand for the nearest and the farthest depth, at most 65535; what lies
  /// outside counts as the nearest end. Below 0: found in the pictures.
  double near_sample = -1;
  double far_sample = -1;
};

/// Throws std::invalid_argument that names what is wrong: a number that is not one, or near and far
/// the wrong way round.
SPIDAR_API void validate(const DepthSettings& settings);

/// Reads depth. After the first picture of a size nothing is taken from the heap. At most four
/// samples of a cell are read, evenly spread, so that the cost does not rise with the size.
///
/// An end of the range that is not set is a percentile of the cells: 2 % of them are nearer than
/// near, 2 % farther than far. Both follow the pictures with a time constant of kRange_s, so that
/// the relief does not pump when something passes in front of the camera. When more than half of
/// the cells lie outside, as after a cut, or when settings change, they follow at once. A range is
/// never narrower than 1/16 of its larger end or 8 samples: a wall has no relief of noise.
class SPIDAR_API DepthPicture {
 public:
  static constexpr int kSamplesAcross = 2;         ///< of a cell, at most; the same down
  static constexpr double kOutside = 0.02;         ///< share of the cells, at each end
  static constexpr double kRange_s = 1.0;          ///< time constant of the range
  static constexpr double kCut = 0.5;              ///< share of the cells outside that is a cut
  static constexpr double kLeastSpan = 8;          ///< samples
  static constexpr double kLeastShare = 1.0 / 16;  ///< of the larger end

  DepthPicture();

  /// `dt_s` is the time since the last picture; not above 0 leaves a range as it is. Returns false,
  /// and keeps the last levels, when the picture has no samples or nothing but holes. The settings
  /// have to be valid.
  bool read(const DepthView& depth, const DepthSettings& settings, double dt_s);

  /// Rows of HeightField::kColumns, from 0 (far) to 1 (near), NaN where there is a hole. All holes
  /// before the first picture.
  const float* levels() const noexcept { return levels_.data(); }
  /// The range that the levels were made with, in samples. Both 0 before the first picture.
  double near_sample() const noexcept { return near_; }
  double far_sample() const noexcept { return far_; }

  /// Another film, or another place in it: the range begins anew.
  void reset() noexcept { has_range_ = false; }

 private:
  struct Ends {
    double low, high;
  };

  bool average(const DepthView& depth);
  void read_row(const DepthView& depth, int y, float* values) const noexcept;
  Ends percentiles() noexcept;
  bool is_cut(const DepthSettings& settings) const noexcept;
  void follow(const DepthSettings& settings, double dt_s) noexcept;

  CellAverage average_;
  std::vector<int> column_;   // of the depth, for each column that is read
  std::vector<float> cells_;  // mean sample
  std::vector<float> levels_;
  std::vector<uint16_t> count_;  // of cells, by their sample
  int read_width_ = 0;
  int from_width_ = 0;
  DepthSettings settings_;  // that the range was found with
  double near_ = 0;
  double far_ = 0;
  bool has_range_ = false;
};

}  // namespace spidar
