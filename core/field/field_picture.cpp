// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/field/field_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "core/field/block_kernels.h"
#include "core/picture/image_view.h"
#include "core/picture/opencv.h"
#include "core/picture/vectors.h"

namespace spidar {
namespace {

/// Area to which a frame is reduced, as nearly as the scales allow.
constexpr double kArea_px2 = 427.0 * 240.0;

// A pixel of the reduced picture covers one and a half of the base, so three in a row a, b, c
// become the two (2 a + b) / 3 and (b + 2 c) / 3. In two dimensions the weights are 4, 2, 2 and 1
// ninths.

/// ninth(v) = (v + 4) / 9 for v ≤ 9 · 255, as a multiplication: 65536 / 9 rounded up is 7282, whose
/// error of 2 / 65536 / 9 a unit is below 0.01 at 2299.
constexpr unsigned kNinth = 7282;

using cv::v_uint16x8;
using cv::v_uint8x16;

v_uint8x16 ninth(const v_uint16x8& low, const v_uint16x8& high) {
  const v_uint16x8 four = cv::v_setall_u16(4);
  const v_uint16x8 factor = cv::v_setall_u16(static_cast<uint16_t>(kNinth));
  return cv::v_pack(cv::v_mul_hi(low + four, factor), cv::v_mul_hi(high + four, factor));
}

/// The three columns of each third of 48 pixels, 16 bits each.
struct Thirds {
  std::array<v_uint16x8, 3> low;
  std::array<v_uint16x8, 3> high;

  explicit Thirds(const uint8_t* pixels) {
    std::array<v_uint8x16, 3> columns;
    cv::v_load_deinterleave(pixels, columns[0], columns[1], columns[2]);
    for (size_t k = 0; k < 3; ++k) cv::v_expand(columns[k], low[k], high[k]);
  }
};

/// Columns of two of three rows, added in pairs.
struct Columns {
  std::array<v_uint16x8, 3> low;
  std::array<v_uint16x8, 3> high;

  Columns(const Thirds& outer, const Thirds& middle) {
    for (size_t k = 0; k < 3; ++k) {
      low[k] = outer.low[k] + outer.low[k] + middle.low[k];
      high[k] = outer.high[k] + outer.high[k] + middle.high[k];
    }
  }

  void store(uint8_t* to) const {
    const v_uint8x16 left = ninth(low[0] + low[0] + low[1], high[0] + high[0] + high[1]);
    const v_uint8x16 right = ninth(low[2] + low[2] + low[1], high[2] + high[2] + high[1]);
    cv::v_store_interleave(to, left, right);
  }
};

/// The two rows of the reduced picture that three rows of the image give. The last vectors end
/// beyond the picture, in what repeat_border() overwrites.
void reduce_rows(const uint8_t* const rows[3], int width, uint8_t* upper, uint8_t* lower) {
  static_assert(PaddedImage::kPad_px >= 32, "a vector ends within the padding");
  for (int x = 0; x < width; x += 32) {
    const int from = x / 2 * 3;
    const Thirds middle(rows[1] + from);
    Columns(Thirds(rows[0] + from), middle).store(upper + x);
    if (lower) Columns(Thirds(rows[2] + from), middle).store(lower + x);
  }
}

/// If more than this fraction of the difference is left, the gain may be chance. Where the camera
/// pans, most of the difference is motion, whatever the light does.
constexpr double kAlike = 0.9;

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

FieldScale field_scale(int base_width, int base_height) {
  FieldScale best = FieldScale::kSame;
  double least = 1e300;
  for (const FieldScale scale : {FieldScale::kSame, FieldScale::kTwoThirds, FieldScale::kHalf}) {
    const double side = 1 / pixels_to_one(scale);
    if (side * std::min(base_width, base_height) < kMinSide_px) continue;
    const double area_px2 = side * side * base_width * base_height;
    const double distance = std::abs(std::log(area_px2 / kArea_px2));
    if (distance < least) {
      least = distance;
      best = scale;
    }
  }
  return best;
}

double pixels_to_one(FieldScale scale) {
  switch (scale) {
    case FieldScale::kSame:
      return 1;
    case FieldScale::kTwoThirds:
      return 1.5;
    case FieldScale::kHalf:
      return 2;
  }
  return 1;
}

void reduce_to_field(const PaddedImage& base, FieldScale scale, PaddedImage& picture) {
  switch (scale) {
    case FieldScale::kSame:
      picture.resize(base.width(), base.height());
      for (int y = 0; y < base.height(); ++y) {
        std::memcpy(picture.row(y), base.row(y), static_cast<size_t>(base.width()));
      }
      break;
    case FieldScale::kTwoThirds:
      reduce_to_two_thirds(base, picture);
      break;
    case FieldScale::kHalf:
      halve(base, picture);
      break;
  }
  picture.repeat_border();
}

void reduce_to_two_thirds(const PaddedImage& image, PaddedImage& reduced) {
  reduced.resize(image.width() * 2 / 3, image.height() * 2 / 3);
  for (int y = 0; y < reduced.height(); y += 2) {
    const int from = y / 2 * 3;
    const bool has_lower = y + 1 < reduced.height();
    const uint8_t* const rows[3] = {image.row(from), image.row(from + 1),
                                    image.row(has_lower ? from + 2 : from + 1)};
    reduce_rows(rows, reduced.width(), reduced.row(y), has_lower ? reduced.row(y + 1) : nullptr);
  }
}

void compensate_light(PaddedImage& coarse_before, const PaddedImage& coarse_now,
                      PaddedImage& before) {
  cv::Scalar mean_before, mean_now, sigma_before, sigma_now;
  cv::meanStdDev(const_mat(coarse_before.view()), mean_before, sigma_before);
  cv::meanStdDev(const_mat(coarse_now.view()), mean_now, sigma_now);
  // Contrast below one grey level is mostly rounding error.
  const bool has_contrast = sigma_before[0] >= 1 && sigma_now[0] >= 1;
  const double gain = has_contrast ? sigma_now[0] / sigma_before[0] : 1;
  std::array<uint8_t, 256> table;
  for (size_t v = 0; v < table.size(); ++v) {
    const double value = gain * (static_cast<double>(v) - mean_before[0]) + mean_now[0];
    table[v] = static_cast<uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
  }
  if (!makes_alike(coarse_before, coarse_now, table)) return;
  replace_values(table, coarse_before);
  replace_values(table, before);
}

}  // namespace spidar
