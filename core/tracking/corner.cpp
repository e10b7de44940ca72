// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/corner.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/vectors.h"

namespace spidar {
namespace {

/// Sums of the derivatives and of their products. Each derivative is twice the true value, because
/// the central differences are not halved.
struct Tensor {
  int xx = 0;
  int xy = 0;
  int yy = 0;
  int x = 0;
  int y = 0;

  void add(int gx, int gy) {
    xx += gx * gx;
    xy += gx * gy;
    yy += gy * gy;
    x += gx;
    y += gy;
  }
  Tensor& operator+=(const Tensor& o) {
    xx += o.xx;
    xy += o.xy;
    yy += o.yy;
    x += o.x;
    y += o.y;
    return *this;
  }
};

/// Smaller eigenvalue of the window's mean structure tensor, (grey / px)²; 0 for an edge. The mean
/// gradient is subtracted: windows are compared without their mean, so a constant slope alone
/// cannot be located.
float strength(const Tensor& t) {
  constexpr float kTwice = 4;  // both derivatives are doubled
  constexpr float kPixels = kCornerWindow_px * kCornerWindow_px;
  const auto x = static_cast<float>(t.x);
  const auto y = static_cast<float>(t.y);
  const float xx = static_cast<float>(t.xx) - x * x / kPixels;
  const float xy = static_cast<float>(t.xy) - x * y / kPixels;
  const float yy = static_cast<float>(t.yy) - y * y / kPixels;
  const float difference = xx - yy;
  const float root = std::sqrt(difference * difference + 4 * xy * xy);
  const float smaller = xx + yy - root;
  const float larger = xx + yy + root;
  return smaller > kLeastRoundness * larger ? 0.5f / (kTwice * kPixels) * smaller : 0.0f;
}

constexpr int kTensorBlock_px = kCornerStep_px;
constexpr int kMostBlocks = kMostCornerBox_px / kTensorBlock_px;
using TensorRow = std::array<Tensor, kMostBlocks>;

/// Tensors of two blocks side by side.
void two_blocks(const uint8_t* pixels, ptrdiff_t stride, Tensor* to) {
  cv::v_int32x4 xx = cv::v_setzero_s32();
  cv::v_int32x4 xy = xx;
  cv::v_int32x4 yy = xx;
  cv::v_int32x4 sx = xx;
  cv::v_int32x4 sy = xx;
  const cv::v_int16x8 ones = cv::v_setall_s16(1);
  const auto load = [](const uint8_t* p) { return cv::v_reinterpret_as_s16(cv::v_load_expand(p)); };
  for (int y = 0; y < kTensorBlock_px; ++y) {
    const uint8_t* row = pixels + y * stride;
    const cv::v_int16x8 gx = load(row + 1) - load(row - 1);
    const cv::v_int16x8 gy = load(row + stride) - load(row - stride);
    xx = cv::v_dotprod(gx, gx, xx);
    xy = cv::v_dotprod(gx, gy, xy);
    yy = cv::v_dotprod(gy, gy, yy);
    sx = cv::v_dotprod(gx, ones, sx);
    sy = cv::v_dotprod(gy, ones, sy);
  }
  // The first two of the four lanes belong to the left block.
  std::array<int, 4> lanes;
  const auto split = [&](const cv::v_int32x4& sums, int Tensor::*part) {
    cv::v_store(lanes.data(), sums);
    to[0].*part = lanes[0] + lanes[1];
    to[1].*part = lanes[2] + lanes[3];
  };
  split(xx, &Tensor::xx);
  split(xy, &Tensor::xy);
  split(yy, &Tensor::yy);
  split(sx, &Tensor::x);
  split(sy, &Tensor::y);
}

Tensor one_block(const uint8_t* pixels, ptrdiff_t stride) {
  Tensor sum;
  for (int y = 0; y < kTensorBlock_px; ++y) {
    for (int x = 0; x < kTensorBlock_px; ++x) {
      const uint8_t* p = pixels + y * stride + x;
      sum.add(p[1] - p[-1], p[stride] - p[-stride]);
    }
  }
  return sum;
}

void row_of_blocks(const uint8_t* pixels, ptrdiff_t stride, int blocks, TensorRow& to) {
  int k = 0;
  for (; k + 2 <= blocks; k += 2) {
    two_blocks(pixels + k * kTensorBlock_px, stride, &to[static_cast<size_t>(k)]);
  }
  for (; k < blocks; ++k) {
    to[static_cast<size_t>(k)] = one_block(pixels + k * kTensorBlock_px, stride);
  }
}

/// The midpoint between the first and the last pixel, which lies between two pixels.
ImagePoint window_centre(int x0, int y0) {
  constexpr float kHalf_px = (kCornerWindow_px - 1) / 2.0f;
  return {static_cast<float>(x0) + kHalf_px, static_cast<float>(y0) + kHalf_px};
}

}  // namespace

Corner best_corner(const PaddedImage& image, const PixelBox& box) {
  const int columns = std::min(box.x1 - box.x0, kMostCornerBox_px) / kTensorBlock_px;
  const int rows = std::min(box.y1 - box.y0, kMostCornerBox_px) / kTensorBlock_px;
  Corner best;
  if (columns < 2) return best;
  std::array<TensorRow, 2> bands;
  for (int j = 0; j < rows; ++j) {
    const int y0 = box.y0 + j * kTensorBlock_px;
    TensorRow& below = bands[static_cast<size_t>(j % 2)];
    row_of_blocks(image.row(y0) + box.x0, image.stride(), columns, below);
    if (j == 0) continue;
    const TensorRow& above = bands[static_cast<size_t>((j + 1) % 2)];
    for (size_t i = 0; i + 1 < static_cast<size_t>(columns); ++i) {
      Tensor window = above[i];
      window += above[i + 1];
      window += below[i];
      window += below[i + 1];
      const float found = strength(window);
      if (found <= best.strength) continue;
      best = {window_centre(box.x0 + static_cast<int>(i) * kTensorBlock_px, y0 - kTensorBlock_px),
              found};
    }
  }
  return best;
}

}  // namespace spidar
