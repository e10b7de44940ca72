// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures how one method of finding motion does on one film. Prints a line `frame,x,y,ms,height`
/// for each frame: its motion in px since the previous frame, the processor time for it without
/// decoding, and the height of the picture.
///   spidar-bench real_film METHOD FILM
/// METHOD is one of the element's settings or one of two flows:
///   default, paper
///   dis       dense flow (DIS, preset medium) at half size
///   vectors   motion vectors of the coded film, which must be H.264 without B frames
/// For the two flows, a homography is fitted robustly at every 16th pixel, and the object is the
/// largest region that deviates from it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/motion_vector.h>
}
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "core/analysis/motion_analyzer.h"
#include "core/motion/camera/motion_models.h"
#include "tests/bench/benchmarks.h"

namespace {

using Eigen::Vector2d;
using spidar::AnalyzerSettings;
using spidar::Displacement;
using spidar::ImageView;
using spidar::ModelKind;
using spidar::MotionModel;
using spidar::RobustFitter;
using spidar::WeightedDisplacements;

constexpr int kGrid_px = 16;
/// What differs from the background by a pixel of a frame 480 lines high and by this fraction of
/// how it moved moves by itself: of four thresholds tried, the one with which DIS is right most
/// often.
constexpr double kLeastFraction = 0.2;

int64_t cpu_ns() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

/// Flow at each point of a grid, px; where it is not known, nothing.
struct Flow {
  int columns = 0;
  int rows = 0;
  std::vector<Vector2d> moved_px;
  std::vector<uint8_t> known;

  Flow(int width, int height)
      : columns(width / kGrid_px),
        rows(height / kGrid_px),
        moved_px(static_cast<size_t>(columns * rows), Vector2d::Zero()),
        known(moved_px.size(), 0) {}
  Vector2d at_px(size_t i) const {
    const auto columns_of = static_cast<size_t>(columns);
    return {kGrid_px * (static_cast<double>(i % columns_of) + 0.5 - columns / 2.0),
            kGrid_px * (static_cast<double>(i / columns_of) + 0.5 - rows / 2.0)};
  }
};

/// Median motion of the largest region that differs from a homography, against it.
class LargestRegion {
 public:
  Vector2d find(const Flow& flow, double px_of_480_lines) {
    WeightedDisplacements evidence;
    for (size_t i = 0; i < flow.known.size(); ++i) {
      if (flow.known[i]) evidence.points.push_back({flow.at_px(i), flow.moved_px[i]});
    }
    if (evidence.points.size() < 16) return Vector2d::Zero();
    evidence.weights.assign(evidence.points.size(), 1.0);
    evidence.sigma_px = px_of_480_lines;
    const MotionModel start = fitter_.start(evidence, {MotionModel(), last_});
    last_ = fitter_.refine(ModelKind::kHomography, start, evidence).value_or(start);
    rest_px_.assign(flow.known.size(), Vector2d::Zero());
    moves_.assign(flow.known.size(), 0);
    for (size_t i = 0; i < flow.known.size(); ++i) {
      if (!flow.known[i]) continue;
      rest_px_[i] = flow.moved_px[i] - last_.displacement_px(flow.at_px(i));
      moves_[i] = rest_px_[i].norm() > px_of_480_lines + kLeastFraction * flow.moved_px[i].norm();
    }
    std::vector<size_t> largest;
    for (size_t i = 0; i < moves_.size(); ++i) {
      if (!moves_[i]) continue;
      std::vector<size_t> region = fill(flow, i);
      if (region.size() > largest.size()) largest = std::move(region);
    }
    if (largest.size() < 3) return Vector2d::Zero();
    return {median(largest, 0), median(largest, 1)};
  }

 private:
  std::vector<size_t> fill(const Flow& flow, size_t seed) {
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

  double median(const std::vector<size_t>& region, Eigen::Index coordinate) const {
    std::vector<double> values;
    for (const size_t i : region) values.push_back(rest_px_[i][coordinate]);
    const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }

  RobustFitter fitter_;
  MotionModel last_;
  std::vector<Vector2d> rest_px_;
  std::vector<uint8_t> moves_;
};

/// Motion of the object in px since the frame before.
class Method {
 public:
  virtual ~Method() = default;
  virtual Vector2d find(const AVFrame& frame, int64_t time_ns) = 0;
};

class Element final : public Method {
 public:
  explicit Element(const AnalyzerSettings& settings) : analyzer_(settings) {}
  Vector2d find(const AVFrame& frame, int64_t time_ns) override {
    const ImageView luma{frame.data[0], frame.width, frame.height, frame.linesize[0]};
    const auto found = analyzer_.analyze(luma, time_ns);
    return found.motion.velocity_px_s * (static_cast<double>(found.interval_ns) * 1e-9);
  }

 private:
  spidar::MotionAnalyzer analyzer_;
};

class Dis final : public Method {
 public:
  Vector2d find(const AVFrame& frame, int64_t) override {
    const cv::Mat luma(frame.height, frame.width, CV_8U, frame.data[0],
                       static_cast<size_t>(frame.linesize[0]));
    cv::resize(luma, now_, {}, 0.5, 0.5, cv::INTER_AREA);
    Vector2d found = Vector2d::Zero();
    if (!before_.empty()) {
      dis_->calc(before_, now_, flow_);
      Flow flow(frame.width, frame.height);
      for (size_t i = 0; i < flow.known.size(); ++i) {
        const int x = (static_cast<int>(i) % flow.columns * kGrid_px + kGrid_px / 2) / 2;
        const int y = (static_cast<int>(i) / flow.columns * kGrid_px + kGrid_px / 2) / 2;
        const cv::Point2f moved = flow_.at<cv::Point2f>(y, x);
        flow.moved_px[i] = 2 * Vector2d(moved.x, moved.y);
        flow.known[i] = 1;
      }
      found = region_.find(flow, frame.height / 480.0);
    }
    cv::swap(before_, now_);
    return found;
  }

 private:
  cv::Ptr<cv::DISOpticalFlow> dis_ = cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM);
  cv::Mat before_;
  cv::Mat now_;
  cv::Mat flow_;
  LargestRegion region_;
};

class Vectors final : public Method {
 public:
  Vector2d find(const AVFrame& frame, int64_t) override {
    const AVFrameSideData* side = av_frame_get_side_data(&frame, AV_FRAME_DATA_MOTION_VECTORS);
    if (!side) return Vector2d::Zero();
    Flow flow(frame.width, frame.height);
    const auto* vectors = reinterpret_cast<const AVMotionVector*>(side->data);
    const size_t count = side->size / sizeof(AVMotionVector);
    std::vector<double> areas(flow.known.size(), 0);
    for (size_t k = 0; k < count; ++k) {
      const AVMotionVector& v = vectors[k];
      const int column = v.dst_x / kGrid_px;
      const int row = v.dst_y / kGrid_px;
      if (v.motion_scale == 0 || column >= flow.columns || row >= flow.rows || v.dst_x < 0 ||
          v.dst_y < 0) {
        continue;
      }
      const auto i = static_cast<size_t>(row * flow.columns + column);
      const double area = v.w * v.h;
      flow.moved_px[i] -= area * Vector2d(v.motion_x, v.motion_y) / v.motion_scale;
      areas[i] += area;
    }
    for (size_t i = 0; i < areas.size(); ++i) {
      if (areas[i] == 0) continue;
      flow.moved_px[i] /= areas[i];
      flow.known[i] = 1;
    }
    return region_.find(flow, frame.height / 480.0);
  }

 private:
  LargestRegion region_;
};

std::unique_ptr<Method> make_method(const std::string& name) {
  if (name == "dis") return std::make_unique<Dis>();
  if (name == "vectors") return std::make_unique<Vectors>();
  if (name == "default") return std::make_unique<Element>(AnalyzerSettings());
  if (name == "paper") return std::make_unique<Element>(spidar::paper_settings());
  throw std::invalid_argument("no method '" + name + "'; there are default, paper, dis, vectors");
}

/// Frames of the first video of a file, with motion vectors where the format has them.
class Film {
 public:
  explicit Film(const std::string& file) {
    AVFormatContext* format = nullptr;
    if (avformat_open_input(&format, file.c_str(), nullptr, nullptr) < 0) {
      throw std::runtime_error(file + ": cannot be read");
    }
    format_.reset(format);
    const AVCodec* codec = nullptr;
    stream_ = avformat_find_stream_info(format, nullptr) < 0
                  ? -1
                  : av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (stream_ < 0) throw std::runtime_error(file + ": has no video");
    codec_.reset(avcodec_alloc_context3(codec));
    avcodec_parameters_to_context(codec_.get(), format->streams[stream_]->codecpar);
    codec_->flags2 |= AV_CODEC_FLAG2_EXPORT_MVS;
    codec_->thread_count = 1;
    if (avcodec_open2(codec_.get(), codec, nullptr) < 0) {
      throw std::runtime_error(file + ": cannot be decoded");
    }
  }

  /// Calls `show(frame, time in ns)` for each frame.
  template <typename Show>
  void play(Show&& show) {
    const auto frame = std::unique_ptr<AVFrame, Free>(av_frame_alloc());
    const auto packet = std::unique_ptr<AVPacket, Free>(av_packet_alloc());
    const double tick_s = av_q2d(format_->streams[stream_]->time_base);
    const auto take = [&] {
      while (avcodec_receive_frame(codec_.get(), frame.get()) >= 0) {
        const double time_s = tick_s * static_cast<double>(frame->best_effort_timestamp);
        show(*frame, static_cast<int64_t>(std::llround(1e9 * time_s)));
      }
    };
    while (av_read_frame(format_.get(), packet.get()) >= 0) {
      if (packet->stream_index == stream_) avcodec_send_packet(codec_.get(), packet.get());
      av_packet_unref(packet.get());
      take();
    }
    avcodec_send_packet(codec_.get(), nullptr);
    take();
  }

 private:
  struct Free {
    void operator()(AVFormatContext* p) const { avformat_close_input(&p); }
    void operator()(AVCodecContext* p) const { avcodec_free_context(&p); }
    void operator()(AVFrame* p) const { av_frame_free(&p); }
    void operator()(AVPacket* p) const { av_packet_free(&p); }
  };
  std::unique_ptr<AVFormatContext, Free> format_;
  std::unique_ptr<AVCodecContext, Free> codec_;
  int stream_ = -1;
};

}  // namespace

int spidar::bench::real_film(int argc, char** argv) {
  if (argc != 3) throw std::invalid_argument("usage: spidar-bench real_film METHOD FILM");
  cv::setNumThreads(1);
  const auto method = make_method(argv[1]);
  int n = 0;
  Film(argv[2]).play([&](const AVFrame& frame, int64_t time_ns) {
    const int64_t begin_ns = cpu_ns();
    const Vector2d found_px = method->find(frame, time_ns);
    std::printf("%d,%.4f,%.4f,%.4f,%d\n", n++, found_px.x(), found_px.y(),
                1e-6 * static_cast<double>(cpu_ns() - begin_ns), frame.height);
  });
  return 0;
}
