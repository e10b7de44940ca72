// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/tracking/peers.h"

#include <algorithm>
#include <utility>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "core/tracking/tracker.h"

namespace spidar::bench {
namespace {

constexpr int kWidth_px = 480;
constexpr int kGrid_px = 16;

cv::Mat as_mat(const ImageView& frame) {
  return cv::Mat(frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.data),
                 static_cast<size_t>(frame.stride_bytes));
}

ImagePoint point(const cv::Point2f& p) {
  return {p.x, p.y};
}

class Paper final : public Peer {
 public:
  const TrackedFrame& track(const ImageView& frame) override { return tracker_.track(frame); }
  void restart() override { tracker_.restart(); }

 private:
  OpenCvTracker tracker_{TrackerSettings()};
};

/// What the others have in common: frames of one size, and none before the first.
class OpenCvFunctions : public Peer {
 public:
  const TrackedFrame& track(const ImageView& frame) override {
    result_.tracks.clear();
    result_.picture = fresh_ ? PictureKind::kFirst : PictureKind::kOther;
    follow(as_mat(frame), fresh_);
    fresh_ = false;
    return result_;
  }
  void restart() override { fresh_ = true; }

 protected:
  /// `first`: there is no frame before.
  virtual void follow(const cv::Mat& frame, bool first) = 0;

  TrackedFrame result_;

 private:
  bool fresh_ = true;
};

class Naive final : public OpenCvFunctions {
  void follow(const cv::Mat& luma, bool first) override {
    // What the conversion costs does not depend on the picture; the luma is that of all pipelines.
    bgr_.create(luma.size(), CV_8UC3);
    cv::cvtColor(bgr_, converted_, cv::COLOR_BGR2GRAY);
    if (!first && !from_.empty()) {
      cv::calcOpticalFlowPyrLK(before_, luma, from_, to_, found_, error_, cv::Size(21, 21), 3);
      for (size_t i = 0; i < from_.size(); ++i) {
        if (found_[i]) result_.tracks.push_back({0, point(from_[i]), point(to_[i])});
      }
    }
    constexpr int kMostPoints = 200;
    const TrackerSettings settings;
    cv::goodFeaturesToTrack(luma, from_, kMostPoints, settings.quality_level,
                            settings.min_distance_px * luma.rows / kReferenceHeight_px);
    result_.features = static_cast<int>(from_.size());
    before_ = luma;  // the caller keeps its frames
  }

  cv::Mat bgr_;
  cv::Mat converted_;
  cv::Mat before_;
  std::vector<cv::Point2f> from_;
  std::vector<cv::Point2f> to_;
  std::vector<uint8_t> found_;
  std::vector<float> error_;
};

/// Dense flow at a width of 480 px, with tracks on a grid.
class Dis final : public OpenCvFunctions {
  void follow(const cv::Mat& luma, bool first) override {
    std::swap(before_, now_);
    const double factor = std::max(1.0, luma.cols / static_cast<double>(kWidth_px));
    const cv::Size size(static_cast<int>(luma.cols / factor), static_cast<int>(luma.rows / factor));
    cv::resize(luma, now_, size, 0, 0, cv::INTER_AREA);
    result_.features = (size.width / kGrid_px) * (size.height / kGrid_px);
    if (first) return;
    dis_->calc(before_, now_, flow_);
    const auto scale = static_cast<float>(factor);
    for (int y = kGrid_px / 2; y + kGrid_px / 2 <= size.height; y += kGrid_px) {
      for (int x = kGrid_px / 2; x + kGrid_px / 2 <= size.width; x += kGrid_px) {
        const cv::Point2f moved = flow_.at<cv::Point2f>(y, x) * scale;
        // Pixels count from the centre of the first one.
        const cv::Point2f from = (cv::Point2f(cv::Point(x, y)) + cv::Point2f(0.5f, 0.5f)) * scale -
                                 cv::Point2f(0.5f, 0.5f);
        result_.tracks.push_back({0, point(from), point(from + moved)});
      }
    }
  }

  cv::Mat before_;
  cv::Mat now_;
  cv::Mat flow_;
  cv::Ptr<cv::DISOpticalFlow> dis_ =
      cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_ULTRAFAST);
};

}  // namespace

std::unique_ptr<Peer> make_paper() {
  return std::make_unique<Paper>();
}
std::unique_ptr<Peer> make_naive() {
  return std::make_unique<Naive>();
}
std::unique_ptr<Peer> make_dis_ultrafast() {
  return std::make_unique<Dis>();
}

}  // namespace spidar::bench
