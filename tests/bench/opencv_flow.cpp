// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/opencv_flow.h"

#include <algorithm>
#include <utility>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace spidar::bench {
namespace {

cv::Mat as_mat(const ImageView& frame) {
  return cv::Mat(frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.data),
                 static_cast<size_t>(frame.stride_bytes));
}

class Dis final : public Flow {
  void find(const ImageView& frame) override {
    constexpr double kWidth_px = 480;
    const double factor = std::max(1.0, frame.width / kWidth_px);
    std::swap(before_, now_);
    cv::resize(as_mat(frame), now_,
               {static_cast<int>(frame.width / factor), static_cast<int>(frame.height / factor)}, 0,
               0, cv::INTER_AREA);
    if (!before_.empty()) dis_->calc(before_, now_, flow_);
  }

  cv::Mat before_, now_, flow_;
  cv::Ptr<cv::DISOpticalFlow> dis_ =
      cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_ULTRAFAST);
};

}  // namespace

std::unique_ptr<Flow> make_dis_ultrafast() {
  return std::make_unique<Dis>();
}

}  // namespace spidar::bench
