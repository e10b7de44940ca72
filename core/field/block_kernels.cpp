#include "core/field/block_kernels.h"

#include <opencv2/core/hal/intrin.hpp>

namespace spidar::vectors {

#if CV_SIMD128
namespace {

using cv::v_int16x8;
using cv::v_int32x4;
using cv::v_uint16x8;
using cv::v_uint8x16;

unsigned difference_of_rows(BlockPixels a, BlockPixels b, int from, int to) {
  unsigned sum = 0;
  for (int y = from; y < to; ++y) {
    sum +=
        cv::v_reduce_sad(cv::v_load(a.pixels + y * a.stride), cv::v_load(b.pixels + y * b.stride));
  }
  return sum;
}

/// Eight pixels, 16 bit each.
v_int16x8 load(const uint8_t* pixels) {
  return cv::v_reinterpret_as_s16(cv::v_load_expand(pixels));
}

/// Derivatives of eight pixels of one picture, `step` bytes between neighbours.
v_int16x8 slope(const uint8_t* pixels, ptrdiff_t step) {
  return load(pixels + step) - load(pixels - step);
}

v_uint16x8 weighted(const v_uint16x8& values, const v_uint16x8& weights) {
  return cv::v_mul_wrap(values, weights);
}

/// Sixteen pixels and their right neighbours, interpolated: no lane is above 255 · kFractionOne.
struct HalfInterpolated {
  v_uint16x8 low;
  v_uint16x8 high;

  HalfInterpolated(const uint8_t* pixels, const v_uint16x8& left, const v_uint16x8& right)
      : low(weighted(cv::v_load_expand(pixels), left) +
            weighted(cv::v_load_expand(pixels + 1), right)),
        high(weighted(cv::v_load_expand(pixels + 8), left) +
             weighted(cv::v_load_expand(pixels + 9), right)) {}
};

}  // namespace

int block_difference(BlockPixels a, BlockPixels b, int limit) {
  constexpr int kHalf = kBlock_px / 2;
  unsigned sum = difference_of_rows(a, b, 0, kHalf);
  if (static_cast<int>(sum) >= limit) return static_cast<int>(sum);
  sum += difference_of_rows(a, b, kHalf, kBlock_px);
  return static_cast<int>(sum);
}

int bilinear_difference(BlockPixels now, BlockPixels before, int fraction_x, int fraction_y) {
  const auto lanes = [](int w) { return cv::v_setall_u16(static_cast<uint16_t>(w)); };
  const v_uint16x8 left = lanes(kFractionOne - fraction_x);
  const v_uint16x8 right = lanes(fraction_x);
  const v_uint16x8 above = lanes(kFractionOne - fraction_y);
  const v_uint16x8 below = lanes(fraction_y);
  const v_uint16x8 half = lanes(128);
  unsigned sum = 0;
  HalfInterpolated upper(before.pixels, left, right);
  for (int y = 0; y < kBlock_px; ++y) {
    const HalfInterpolated lower(before.pixels + (y + 1) * before.stride, left, right);
    const v_uint16x8 low = (weighted(upper.low, above) + weighted(lower.low, below) + half) >> 8;
    const v_uint16x8 high = (weighted(upper.high, above) + weighted(lower.high, below) + half) >> 8;
    sum += cv::v_reduce_sad(cv::v_pack(low, high), cv::v_load(now.pixels + y * now.stride));
    upper = lower;
  }
  return static_cast<int>(sum);
}

BlockSums compare_blocks(BlockPixels now, BlockPixels before) {
  const v_int16x8 ones = cv::v_setall_s16(1);
  v_int32x4 xx = cv::v_setzero_s32();
  v_int32x4 xy = xx;
  v_int32x4 yy = xx;
  v_int32x4 sx = xx;
  v_int32x4 sy = xx;
  v_int32x4 xd = xx;
  v_int32x4 yd = xx;
  v_int32x4 sd = xx;
  v_int32x4 dd = xx;
  for (int y = 0; y < kBlock_px; ++y) {
    for (int x = 0; x < kBlock_px; x += 8) {
      const uint8_t* p = now.pixels + y * now.stride + x;
      const uint8_t* q = before.pixels + y * before.stride + x;
      const v_int16x8 gx = slope(p, 1) + slope(q, 1);
      const v_int16x8 gy = slope(p, now.stride) + slope(q, before.stride);
      const v_int16x8 d = load(p) - load(q);
      xx = cv::v_dotprod(gx, gx, xx);
      xy = cv::v_dotprod(gx, gy, xy);
      yy = cv::v_dotprod(gy, gy, yy);
      sx = cv::v_dotprod(gx, ones, sx);
      sy = cv::v_dotprod(gy, ones, sy);
      xd = cv::v_dotprod(gx, d, xd);
      yd = cv::v_dotprod(gy, d, yd);
      sd = cv::v_dotprod(d, ones, sd);
      dd = cv::v_dotprod(d, d, dd);
    }
  }
  // Σ gx² is at most 1020² · 256 < 2³¹.
  const auto total = [](const v_int32x4& sums) { return cv::v_reduce_sum(sums); };
  return {total(xx), total(xy), total(yy), total(sx), total(sy),
          total(xd), total(yd), total(sd), total(dd)};
}
#else
int block_difference(BlockPixels a, BlockPixels b, int limit) {
  return plain::block_difference(a, b, limit);
}

int bilinear_difference(BlockPixels now, BlockPixels before, int fraction_x, int fraction_y) {
  return plain::bilinear_difference(now, before, fraction_x, fraction_y);
}

BlockSums compare_blocks(BlockPixels now, BlockPixels before) {
  return plain::compare_blocks(now, before);
}
#endif

}  // namespace spidar::vectors
