// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Measures how one method of finding motion does on one film. Prints a line
/// `frame,ms,height,x,y...` for each frame: the processor time for it without decoding, the height
/// of the picture, and its motion in px since the previous frame, by threshold (flow_methods.h).
///   spidar-bench real_film METHOD FILM
/// METHOD is one of flow_methods.h, or `vectors`: the motion vectors of the coded film, which must
/// be H.264 without B frames (of HEVC, FFmpeg's decoder gives none).
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
#include <opencv2/core/utility.hpp>

#include "tests/bench/benchmarks.h"
#include "tests/bench/flow_methods.h"

namespace {

using Eigen::Vector2d;
using spidar::ImageView;
using spidar::bench::FlowGrid;
using spidar::bench::LargestRegion;
using spidar::bench::make_method;

int64_t cpu_ns() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

/// The motion vectors that a decoded frame carries, as a method.
class Vectors {
 public:
  std::vector<Vector2d> find(const AVFrame& frame) {
    const AVFrameSideData* side = av_frame_get_side_data(&frame, AV_FRAME_DATA_MOTION_VECTORS);
    if (!side) return std::vector<Vector2d>(spidar::bench::thresholds().size(), Vector2d::Zero());
    FlowGrid flow(frame.width, frame.height);
    const auto* vectors = reinterpret_cast<const AVMotionVector*>(side->data);
    const size_t count = side->size / sizeof(AVMotionVector);
    std::vector<double> areas(flow.known.size(), 0);
    for (size_t k = 0; k < count; ++k) {
      const AVMotionVector& v = vectors[k];
      const int column = v.dst_x / FlowGrid::kStep_px;
      const int row = v.dst_y / FlowGrid::kStep_px;
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
  const auto method = argv[1] == std::string("vectors") ? nullptr : make_method(argv[1]);
  Vectors vectors;
  int n = 0;
  Film(argv[2]).play([&](const AVFrame& frame, int64_t time_ns) {
    const int64_t begin_ns = cpu_ns();
    const ImageView luma{frame.data[0], frame.width, frame.height, frame.linesize[0]};
    const std::vector<Vector2d> found_px =
        method ? method->find(luma, time_ns) : vectors.find(frame);
    std::printf("%d,%.4f,%d", n++, 1e-6 * static_cast<double>(cpu_ns() - begin_ns), frame.height);
    for (const Vector2d& each_px : found_px) std::printf(",%.4f,%.4f", each_px.x(), each_px.y());
    std::printf("\n");
  });
  return 0;
}
