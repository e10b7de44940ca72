// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The parts of OpenCV that the project uses: its view of a picture, its functions on one thread,
/// and its vectors of 16 bytes, which are emulated where the processor has none. intrin.hpp needs
/// core.hpp and does not include it.
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/core/utility.hpp>

#include "core/picture/image_view.h"

namespace spidar {

/// `width` × `height` elements of an OpenCV type. cv::Mat has no const view: only for functions
/// that do not write to their input.
inline cv::Mat const_mat(const uint8_t* data, int width, int height, int type,
                         ptrdiff_t stride_bytes) {
  return {height, width, type, const_cast<uint8_t*>(data), static_cast<size_t>(stride_bytes)};
}
inline cv::Mat const_mat(const ImageView& view) {
  return const_mat(view.data, view.width, view.height, CV_8U, view.stride_bytes);
}

/// Runs `work` so that OpenCV functions in it stay on the calling thread.
///
/// The streaming thread shares the machine with a decoder and the 1 kHz loop. A second thread would
/// take a core away from these and, with the tracker's small pictures, save less than a millisecond
/// per frame. A library should not call cv::setNumThreads(), which affects the whole process.
/// OpenCV does not split a parallel_for_ inside another one, so this function runs the work as the
/// single stripe of a parallel_for_. The only side effect is that parallel loops of other threads
/// are not split either in the meantime.
template <typename Work>
void run_on_this_thread(Work&& work) {
  cv::parallel_for_(cv::Range(0, 1), [&work](const cv::Range&) { work(); });
}

/// Σ |a − b| over rows of 16 pixels. x86 adds up eight pixels in one instruction; combining its two
/// sums for each row, as cv::v_reduce_sad() does, would cost twice as much as the differences.
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
