// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/tracking/luma_reduce.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace spidar {
namespace {

constexpr int kReducedSide_px = 480;

}  // namespace

int reduction_factor(int width, int height) {
  const int nearest = (std::max(width, height) + kReducedSide_px / 2) / kReducedSide_px;
  return std::max(1, std::min(nearest, std::min(width, height) / kMinSide_px));
}

void reduce_luma(const ImageView& frame, int factor, cv::Mat& reduced) {
  // cv::Mat has no const view; nothing writes through this one.
  const cv::Mat whole_blocks(frame.height / factor * factor, frame.width / factor * factor, CV_8UC1,
                             const_cast<uint8_t*>(frame.data),
                             static_cast<size_t>(frame.stride_bytes));
  reduced = whole_blocks;
  // Halves as often as possible, because OpenCV has vector code only for 2 × 2 blocks.
  for (int rest = factor; rest > 1;) {
    const int step = rest % 2 == 0 ? 2 : rest;
    cv::Mat smaller;
    cv::resize(reduced, smaller, cv::Size(reduced.cols / step, reduced.rows / step), 0, 0,
               cv::INTER_AREA);
    reduced = smaller;
    rest /= step;
  }
}

}  // namespace spidar
