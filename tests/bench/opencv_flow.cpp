// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/opencv_flow.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "core/tracking/tracker.h"

namespace spidar::bench {
namespace {

cv::Mat as_mat(const ImageView& frame) {
  return cv::Mat(frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.data),
                 static_cast<size_t>(frame.stride_bytes));
}

class Naive final : public Flow {
  void find(const ImageView& frame) override {
    const cv::Mat luma = as_mat(frame);
    // What the conversion costs does not depend on the picture; the luma is the same for all.
    bgr_.create(luma.size(), CV_8UC3);
    cv::cvtColor(bgr_, converted_, cv::COLOR_BGR2GRAY);
    if (!from_.empty()) {
      cv::calcOpticalFlowPyrLK(before_, luma, from_, to_, found_, error_, cv::Size(21, 21), 3);
    }
    constexpr int kMostPoints = 200;
    const TrackerSettings settings;
    cv::goodFeaturesToTrack(luma, from_, kMostPoints, settings.quality_level,
                            settings.min_distance_px * luma.rows / kReferenceHeight_px);
    before_ = luma;
  }

  cv::Mat bgr_, converted_, before_;
  std::vector<cv::Point2f> from_, to_;
  std::vector<uint8_t> found_;
  std::vector<float> error_;
};

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

std::unique_ptr<Flow> make_naive() {
  return std::make_unique<Naive>();
}
std::unique_ptr<Flow> make_dis_ultrafast() {
  return std::make_unique<Dis>();
}

}  // namespace spidar::bench
