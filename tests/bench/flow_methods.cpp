// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/bench/flow_methods.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "core/analysis/motion_analyzer.h"

namespace spidar::bench {
namespace {

using Eigen::Vector2d;

/// What differs from the background by a threshold and by this fraction of how it moved moves by
/// itself.
constexpr double kMinFraction = 0.2;
constexpr double kReferenceLines = 480;

cv::Mat as_mat(const ImageView& frame) {
  return cv::Mat(frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.data),
                 static_cast<size_t>(frame.stride_bytes));
}

class Element final : public Method {
 public:
  explicit Element(const AnalyzerSettings& settings, double size = 1)
      : analyzer_(settings), size_(size) {}

  std::vector<Vector2d> find(const ImageView& frame, int64_t time_ns) override {
    if (size_ == 1) return {look(frame, time_ns)};
    cv::resize(as_mat(frame), small_, {}, size_, size_, cv::INTER_AREA);
    const ImageView small{small_.data, small_.cols, small_.rows, static_cast<int>(small_.step)};
    return {look(small, time_ns) / size_};
  }

 private:
  Vector2d look(const ImageView& frame, int64_t time_ns) {
    const auto& found = analyzer_.analyze(frame, time_ns);
    return found.motion.velocity_px_s * (static_cast<double>(found.interval_ns) * 1e-9);
  }

  MotionAnalyzer analyzer_;
  const double size_;
  cv::Mat small_;
};

/// Compares pictures of `size` times the width of the frames. What is compared fills a FlowGrid of
/// the frame.
class PictureFlow : public Method {
 public:
  explicit PictureFlow(double size) : size_(size) {}

  std::vector<Vector2d> find(const ImageView& frame, int64_t) final {
    const cv::Mat luma = as_mat(frame);
    if (size_ < 1)
      cv::resize(luma, now_, {}, size_, size_, cv::INTER_AREA);
    else
      luma.copyTo(now_);
    std::vector<Vector2d> found(thresholds().size(), Vector2d::Zero());
    if (before_.size() == now_.size()) {
      FlowGrid flow(frame.width, frame.height);
      compare(before_, now_, flow);
      found = region_.find(flow, frame.height / kReferenceLines);
    }
    cv::swap(before_, now_);
    return found;
  }

 protected:
  virtual void compare(const cv::Mat& before, const cv::Mat& now, FlowGrid& flow) = 0;

  void sample(const cv::Mat& field, FlowGrid& flow) const {
    for (size_t i = 0; i < flow.known.size(); ++i) {
      const auto at = [&](size_t cell, int most) {
        return std::min(
            static_cast<int>(size_ * FlowGrid::kStep_px * (static_cast<double>(cell) + 0.5)),
            most - 1);
      };
      const auto columns = static_cast<size_t>(flow.columns);
      const cv::Point2f moved =
          field.at<cv::Point2f>(at(i / columns, field.rows), at(i % columns, field.cols));
      flow.moved_px[i] = Vector2d(moved.x, moved.y) / size_;
      flow.known[i] = 1;
    }
  }

  const double size_;

 private:
  cv::Mat before_, now_;
  LargestRegion region_;
};

/// A dense flow of OpenCV.
class Dense final : public PictureFlow {
 public:
  Dense(cv::Ptr<cv::DenseOpticalFlow> dense, double size) : PictureFlow(size), dense_(dense) {}

 private:
  void compare(const cv::Mat& before, const cv::Mat& now, FlowGrid& flow) override {
    dense_->calc(before, now, field_);
    sample(field_, flow);
  }

  cv::Ptr<cv::DenseOpticalFlow> dense_;
  cv::Mat field_;
};

/// New points in each frame: where several are in a cell of the grid, their mean.
class Sparse final : public PictureFlow {
 public:
  explicit Sparse(int points) : PictureFlow(1), points_(points) {}

 private:
  void compare(const cv::Mat& before, const cv::Mat& now, FlowGrid& flow) override {
    // OpenCV's defaults for quality and windows; a distance that leaves room for all points.
    const double apart_px = std::max(3.0, std::sqrt(before.cols * before.rows / (4.0 * points_)));
    cv::goodFeaturesToTrack(before, from_, points_, 0.01, apart_px);
    if (from_.empty()) return;
    cv::calcOpticalFlowPyrLK(before, now, from_, to_, found_, error_, cv::Size(21, 21), 3);
    std::vector<int> count(flow.known.size(), 0);
    for (size_t k = 0; k < from_.size(); ++k) {
      const int column = static_cast<int>(from_[k].x) / FlowGrid::kStep_px;
      const int row = static_cast<int>(from_[k].y) / FlowGrid::kStep_px;
      if (!found_[k] || column >= flow.columns || row >= flow.rows) continue;
      const auto i = static_cast<size_t>(row * flow.columns + column);
      const cv::Point2f moved = to_[k] - from_[k];
      flow.moved_px[i] += (Vector2d(moved.x, moved.y) - flow.moved_px[i]) / ++count[i];
      flow.known[i] = 1;
    }
  }

  const int points_;
  std::vector<cv::Point2f> from_, to_;
  std::vector<uint8_t> found_;
  std::vector<float> error_;
};

/// Each block with a Hann window; a block whose peak is no peak says nothing.
class Phase final : public PictureFlow {
 public:
  explicit Phase(double size) : PictureFlow(size) {
    cv::createHanningWindow(window_, {kBlock_px, kBlock_px}, CV_32F);
  }

 private:
  static constexpr int kBlock_px = 32;
  static constexpr double kLeastResponse = 0.1;  // of noise against noise: 0.05

  void compare(const cv::Mat& before, const cv::Mat& now, FlowGrid& flow) override {
    before.convertTo(before_32_, CV_32F);
    now.convertTo(now_32_, CV_32F);
    const double cell_px = size_ * FlowGrid::kStep_px;
    for (int y = 0; y + kBlock_px <= now.rows; y += kBlock_px) {
      for (int x = 0; x + kBlock_px <= now.cols; x += kBlock_px) {
        const cv::Rect block(x, y, kBlock_px, kBlock_px);
        double response = 0;
        const cv::Point2d moved =
            cv::phaseCorrelate(before_32_(block), now_32_(block), window_, &response);
        if (response < kLeastResponse) continue;
        const auto cells = [&](int from, int most) {
          return std::pair(static_cast<int>(from / cell_px),
                           std::min(most, static_cast<int>((from + kBlock_px) / cell_px)));
        };
        const auto [top, bottom] = cells(y, flow.rows);
        const auto [left, right] = cells(x, flow.columns);
        for (int row = top; row < bottom; ++row) {
          for (int column = left; column < right; ++column) {
            const auto i = static_cast<size_t>(row * flow.columns + column);
            flow.moved_px[i] = Vector2d(moved.x, moved.y) / size_;
            flow.known[i] = 1;
          }
        }
      }
    }
  }

  cv::Mat window_, before_32_, now_32_;
};

cv::Ptr<cv::DenseOpticalFlow> make_dis(const std::string& preset) {
  using Dis = cv::DISOpticalFlow;
  if (preset == "ultrafast") return Dis::create(Dis::PRESET_ULTRAFAST);
  if (preset == "medium") return Dis::create(Dis::PRESET_MEDIUM);
  return nullptr;
}

}  // namespace

std::unique_ptr<Method> make_method(const std::string& name) {
  std::istringstream parts(name);
  std::string kind, preset;
  std::getline(parts, kind, ':');
  if (kind == "dis") std::getline(parts, preset, ':');
  double number = 0;
  if (kind == "paper") return std::make_unique<Element>(paper_settings());
  if (parts >> number && number > 0 && parts.peek() == EOF) {
    if (kind == "lk") return std::make_unique<Sparse>(static_cast<int>(number));
    if (number <= 1) {
      if (kind == "object") return std::make_unique<Element>(AnalyzerSettings(), number);
      const auto dis = make_dis(preset);
      if (dis) return std::make_unique<Dense>(dis, number);
      if (kind == "phase") return std::make_unique<Phase>(number);
    }
  }
  throw std::invalid_argument("no method '" + name +
                              "'; there are paper, object:SIZE, dis:ultrafast|medium:SIZE, "
                              "phase:SIZE with a SIZE of at most 1, "
                              "lk:POINTS");
}

Vector2d FlowGrid::at_px(size_t i) const {
  const auto columns_of = static_cast<size_t>(columns);
  return {kStep_px * (static_cast<double>(i % columns_of) + 0.5 - columns / 2.0),
          kStep_px * (static_cast<double>(i / columns_of) + 0.5 - rows / 2.0)};
}

const std::vector<Threshold>& thresholds() {
  static const std::vector<Threshold> all = [] {
    std::vector<Threshold> tried;
    for (const double px : {1.0, 2.0, 4.0}) {
      for (const size_t cells : {size_t{3}, size_t{8}, size_t{24}, size_t{48}})
        tried.push_back({px, cells});
    }
    return tried;
  }();
  return all;
}

std::vector<Vector2d> LargestRegion::find(const FlowGrid& flow, double px_of_480_lines) {
  std::vector<Vector2d> found(thresholds().size(), Vector2d::Zero());
  WeightedDisplacements evidence;
  for (size_t i = 0; i < flow.known.size(); ++i) {
    if (flow.known[i]) evidence.points.push_back({flow.at_px(i), flow.moved_px[i]});
  }
  if (evidence.points.size() < 16) return found;
  evidence.weights.assign(evidence.points.size(), 1.0);
  evidence.sigma_px = px_of_480_lines;
  const MotionModel start = find_start(evidence, {MotionModel(), last_});
  last_ = fit_robustly(ModelKind::kHomography, start, evidence).value_or(start);
  rest_px_.assign(flow.known.size(), Vector2d::Zero());
  for (size_t i = 0; i < flow.known.size(); ++i) {
    if (flow.known[i]) rest_px_[i] = flow.moved_px[i] - last_.displacement_px(flow.at_px(i));
  }
  double least_px = 0;
  std::vector<size_t> region;
  for (size_t k = 0; k < found.size(); ++k) {
    const Threshold& threshold = thresholds()[k];
    if (threshold.least_px != least_px) {
      least_px = threshold.least_px;
      region = largest(flow, least_px * px_of_480_lines);
    }
    if (region.size() >= threshold.least_cells) found[k] = {median(region, 0), median(region, 1)};
  }
  return found;
}

std::vector<size_t> LargestRegion::largest(const FlowGrid& flow, double least_px) {
  moves_.assign(flow.known.size(), 0);
  for (size_t i = 0; i < flow.known.size(); ++i) {
    moves_[i] =
        flow.known[i] && rest_px_[i].norm() > least_px + kMinFraction * flow.moved_px[i].norm();
  }
  std::vector<size_t> found;
  for (size_t i = 0; i < moves_.size(); ++i) {
    if (!moves_[i]) continue;
    std::vector<size_t> region = fill(flow, i);
    if (region.size() > found.size()) found = std::move(region);
  }
  return found;
}

std::vector<size_t> LargestRegion::fill(const FlowGrid& flow, size_t seed) {
  std::vector<size_t> region{seed};
  moves_[seed] = 0;
  for (size_t k = 0; k < region.size(); ++k) {
    const int column = static_cast<int>(region[k]) % flow.columns;
    const int row = static_cast<int>(region[k]) / flow.columns;
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, flow.rows - 1); ++y) {
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, flow.columns - 1); ++x) {
        const auto i = static_cast<size_t>(y * flow.columns + x);
        if (!moves_[i]) continue;
        moves_[i] = 0;
        region.push_back(i);
      }
    }
  }
  return region;
}

double LargestRegion::median(const std::vector<size_t>& region, Eigen::Index coordinate) const {
  std::vector<double> values;
  for (const size_t i : region) values.push_back(rest_px_[i][coordinate]);
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace spidar::bench
