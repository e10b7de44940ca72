#include "core/luma_reduce.h"

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
  const int width = frame.width / factor;
  const int height = frame.height / factor;
  // OpenCV has no constant view; nothing writes through this one.
  const cv::Mat whole_blocks(height * factor, width * factor, CV_8UC1,
                             const_cast<uint8_t*>(frame.data),
                             static_cast<size_t>(frame.stride_bytes));
  if (factor == 1) {
    reduced = whole_blocks;
  } else {
    cv::resize(whole_blocks, reduced, cv::Size(width, height), 0, 0, cv::INTER_AREA);
  }
}

}  // namespace spidar
