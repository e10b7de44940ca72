// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/window_kernels.h"

#include <array>

#include "core/vectors.h"

namespace spidar {

namespace {

using cv::v_int16x8;
using cv::v_int32x4;
using cv::v_uint16x8;

struct Weights {
  v_uint16x8 w00, w01, w10, w11;

  explicit Weights(const BilinearWeights& w)
      : w00(lanes(w.w00)), w01(lanes(w.w01)), w10(lanes(w.w10)), w11(lanes(w.w11)) {}

 private:
  static v_uint16x8 lanes(int w) { return cv::v_setall_u16(static_cast<uint16_t>(w)); }
};

/// Eight pixels and their right neighbours.
struct Neighbours {
  v_uint16x8 left, right;

  explicit Neighbours(const uint8_t* pixels)
      : left(cv::v_load_expand(pixels)), right(cv::v_load_expand(pixels + 1)) {}
};

/// Eight interpolated pixels in pixel units; no sum is above 255 · 256 + 4.
v_int16x8 interpolate(const Neighbours& upper, const Neighbours& lower, const Weights& w) {
  const v_uint16x8 sum = cv::v_mul_wrap(upper.left, w.w00) + cv::v_mul_wrap(upper.right, w.w01) +
                         cv::v_mul_wrap(lower.left, w.w10) + cv::v_mul_wrap(lower.right, w.w11);
  return cv::v_reinterpret_as_s16((sum + cv::v_setall_u16(4)) >> 3);
}

/// `columns` (a multiple of 8) × `rows` interpolated pixels.
template <int kRows, int kColumns>
void interpolate(const WindowSource& from, int16_t* to) {
  const Weights weights(from.weights);
  for (int x = 0; x < kColumns; x += 8) {
    const uint8_t* pixels = from.pixels + x;
    Neighbours upper(pixels);
    for (int y = 0; y < kRows; ++y) {
      pixels += from.stride;
      const Neighbours lower(pixels);
      cv::v_store(to + y * kColumns + x, interpolate(upper, lower, weights));
      upper = lower;
    }
  }
}

v_int16x8 quarter(const v_int16x8& value) {
  return (value + cv::v_setall_s16(2)) >> 2;
}

/// With a side of up to 24 no lane overflows, but the sum of the lanes may.
int64_t total(const v_int32x4& sums) {
  cv::v_int64x2 low;
  cv::v_int64x2 high;
  cv::v_expand(sums, low, high);
  return cv::v_reduce_sum(low + high);
}

}  // namespace

template <int kSide>
TemplateSums read_template(const WindowSource& from, TemplatePixels<kSide>& to) {
  constexpr int kStride = kSide + 8;  // one more pixel on each side, rounded up to whole vectors
  std::array<int16_t, static_cast<size_t>((kSide + 2) * kStride)> wide;
  interpolate<kSide + 2, kStride>(from, wide.data());

  const v_int16x8 ones = cv::v_setall_s16(1);
  v_int32x4 xx = cv::v_setzero_s32();
  v_int32x4 xy = xx;
  v_int32x4 yy = xx;
  v_int32x4 sx = xx;
  v_int32x4 sy = xx;
  v_int32x4 sp = xx;
  v_int32x4 spp = xx;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; x += 8) {
      const int16_t* at = wide.data() + (y + 1) * kStride + x + 1;
      const int k = y * kSide + x;
      const v_int16x8 pixel = cv::v_load(at);
      const v_int16x8 dx = quarter(cv::v_load(at + 1) - cv::v_load(at - 1));
      const v_int16x8 dy = quarter(cv::v_load(at + kStride) - cv::v_load(at - kStride));
      cv::v_store_aligned(to.pixel + k, pixel);
      cv::v_store_aligned(to.dx + k, dx);
      cv::v_store_aligned(to.dy + k, dy);
      xx = cv::v_dotprod(dx, dx, xx);
      xy = cv::v_dotprod(dx, dy, xy);
      yy = cv::v_dotprod(dy, dy, yy);
      sx = cv::v_dotprod(dx, ones, sx);
      sy = cv::v_dotprod(dy, ones, sy);
      const v_int16x8 coarse = quarter(pixel);
      sp = cv::v_dotprod(coarse, ones, sp);
      spp = cv::v_dotprod(coarse, coarse, spp);
    }
  }
  return {total(xx), total(xy), total(yy), total(sx), total(sy), total(sp), total(spp)};
}

template <int kSide>
DifferenceSums compare(const WindowSource& window, const TemplatePixels<kSide>& with, int gain) {
  const Weights weights(window.weights);
  const v_int16x8 gains = cv::v_setall_s16(static_cast<int16_t>(gain));
  const v_int16x8 ones = cv::v_setall_s16(1);
  v_int32x4 sx = cv::v_setzero_s32();
  v_int32x4 sy = sx;
  v_int32x4 sd = sx;
  v_int32x4 sdd = sx;
  v_int32x4 sp = sx;
  v_int32x4 spp = sx;
  for (int x = 0; x < kSide; x += 8) {
    const uint8_t* pixels = window.pixels + x;
    Neighbours upper(pixels);
    for (int y = 0; y < kSide; ++y) {
      pixels += window.stride;
      const Neighbours lower(pixels);
      const v_int16x8 now = interpolate(upper, lower, weights);
      upper = lower;
      const int k = y * kSide + x;
      const v_int16x8 expected = cv::v_mul_hi(cv::v_load_aligned(with.pixel + k) << 2, gains);
      const v_int16x8 d = quarter(now - expected);
      sx = cv::v_dotprod(d, cv::v_load_aligned(with.dx + k), sx);
      sy = cv::v_dotprod(d, cv::v_load_aligned(with.dy + k), sy);
      sd = cv::v_dotprod(d, ones, sd);
      sdd = cv::v_dotprod(d, d, sdd);
      const v_int16x8 coarse = quarter(now);
      sp = cv::v_dotprod(coarse, ones, sp);
      spp = cv::v_dotprod(coarse, coarse, spp);
    }
  }
  return {total(sx), total(sy), total(sd), total(sdd), total(sp), total(spp)};
}

template TemplateSums read_template(const WindowSource&, TemplatePixels<16>&);
template TemplateSums read_template(const WindowSource&, TemplatePixels<24>&);
template DifferenceSums compare(const WindowSource&, const TemplatePixels<16>&, int);
template DifferenceSums compare(const WindowSource&, const TemplatePixels<24>&, int);

}  // namespace spidar
