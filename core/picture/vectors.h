// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// OpenCV's vectors of 16 bytes: the processor's, or an emulation where it has none. The emulation
/// needs what opencv2/core.hpp declares and does not include it.
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

namespace spidar {

/// Σ |a − b| over rows of 16 pixels. x86 adds up eight pixels in one instruction; taking its two
/// sums together for each row, as cv::v_reduce_sad() does, would cost twice as much as the
/// differences.
class DifferenceSum {
 public:
  void add(const cv::v_uint8x16& a, const cv::v_uint8x16& b) {
#if CV_SSE2
    sums_ = _mm_add_epi64(sums_, _mm_sad_epu8(a.val, b.val));
#else
    sum_ += cv::v_reduce_sad(a, b);
#endif
  }
  void add(const uint8_t* a, const uint8_t* b) {
    add(cv::v_load(a), cv::v_load(b));
  }

  unsigned total() const {
#if CV_SSE2
    const __m128i both = _mm_add_epi64(sums_, _mm_unpackhi_epi64(sums_, sums_));
    return static_cast<unsigned>(_mm_cvtsi128_si32(both));
#else
    return sum_;
#endif
  }

 private:
#if CV_SSE2
  __m128i sums_ = _mm_setzero_si128();
#else
  unsigned sum_ = 0;
#endif
};

}  // namespace spidar
