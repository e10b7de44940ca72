// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Milliseconds for the analysis of a frame, compared with a straightforward use of the same OpenCV
// functions. Both run on one thread, on the same frames of a camera that pans over a texture. Also
// compares frames of 8 bits with frames of 10 bits in words of two bytes, and measures a dense flow
// alone (OpenCV's DIS), without the steps from flow to force.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "core/analysis/motion_analyzer.h"
#include "tests/support/picture.h"
#include "tests/support/texture.h"

namespace {

using spidar::ImageView;
using spidar::test::Picture;
using spidar::test::Texture;

constexpr int64_t kFrame_ns = 33'333'333;
constexpr int kFeatures = 200;
constexpr double kQuality = 0.01;
constexpr double kMinDistance_px = 10;  // of the reference frame

/// Frames of `width` × `width · 9 / 16` px, cut out of a larger texture: nothing is drawn or copied
/// while the clock runs.
class Pan {
 public:
  explicit Pan(int width)
      : width_(width),
        height_(width * 9 / 16),
        step_px_(width / 160),
        sheet_(width_ + kSteps * step_px_, height_ + kSteps * step_px_) {
    const Texture texture(1, height_ / 45.0);
    sheet_.fill([&](double x, double y) { return texture.at(x, y); });
    for (const uint8_t level : sheet_.pixels) words_.push_back(static_cast<uint16_t>(4 * level));
  }

  int height() const { return height_; }

  /// 4 px to the side and 2 up or down for each 640 px of width, there and back.
  ImageView frame(int n) const {
    return {sheet_.pixels.data() + offset(n), width_, height_, sheet_.stride};
  }

  /// The same as I420_10LE has it.
  ImageView frame_of_10_bits(int n) const {
    return {reinterpret_cast<const uint8_t*>(words_.data() + offset(n)),
            width_,
            height_,
            2 * ptrdiff_t{sheet_.stride},
            {2, 2, false}};
  }

 private:
  ptrdiff_t offset(int n) const {
    const int place = n % (2 * kSteps) < kSteps ? n % kSteps : kSteps - n % kSteps;
    return place * step_px_ + place * (step_px_ / 2) * ptrdiff_t{sheet_.stride};
  }

  static constexpr int kSteps = 40;
  int width_;
  int height_;
  int step_px_;
  Picture sheet_;
  std::vector<uint16_t> words_;
};

const Pan& pan(int width) {
  static std::map<int, std::unique_ptr<Pan>> pans;
  std::unique_ptr<Pan>& found = pans[width];
  if (!found) found = std::make_unique<Pan>(width);
  return *found;
}

/// Median milliseconds of the analyzer, by width: the naive wiring is compared with it.
std::map<int, double>& analyzer_ms() {
  static std::map<int, double> ms;
  return ms;
}

double thread_time_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

double quantile(std::vector<double>& sorted, double q) {
  return sorted[static_cast<size_t>(q * static_cast<double>(sorted.size() - 1))];
}

/// Calls `work` with frame after frame and reports the distribution; returns the median, ms.
template <typename Work>
double run(benchmark::State& state, const Pan& scene, Work&& work) {
  std::vector<double> ms;
  int n = 0;
  for (auto _ : state) {
    const ImageView frame = scene.frame(n);
    const double begin_ms = thread_time_ms();
    work(frame, n);
    ms.push_back(thread_time_ms() - begin_ms);
    ++n;
  }
  std::sort(ms.begin(), ms.end());
  state.counters["median_ms"] = quantile(ms, 0.5);
  state.counters["p99_ms"] = quantile(ms, 0.99);
  return quantile(ms, 0.5);
}

void analyze(benchmark::State& state) {
  const auto width = static_cast<int>(state.range(0));
  spidar::MotionAnalyzer analyzer;
  double tracked = 0;
  analyzer_ms()[width] = run(state, pan(width), [&](const ImageView& frame, int n) {
    tracked += analyzer.analyze(frame, n * kFrame_ns).motion.tracked;
  });
  state.counters["tracked"] = tracked / static_cast<double>(state.iterations());
}

/// Frames of 8 and of 10 bits in turns, so that what disturbs meets both.
void analyze_10_bits(benchmark::State& state) {
  const Pan& scene = pan(static_cast<int>(state.range(0)));
  spidar::MotionAnalyzer of_8, of_10;
  std::vector<double> ms_8, ms_10;
  const auto timed = [](auto&& work) {
    const double begin_ms = thread_time_ms();
    work();
    return thread_time_ms() - begin_ms;
  };
  int n = 0;
  for (auto _ : state) {
    ms_8.push_back(timed([&] { of_8.analyze(scene.frame(n), n * kFrame_ns); }));
    ms_10.push_back(timed([&] { of_10.analyze(scene.frame_of_10_bits(n), n * kFrame_ns); }));
    ++n;
  }
  std::sort(ms_8.begin(), ms_8.end());
  std::sort(ms_10.begin(), ms_10.end());
  state.counters["median_ms"] = quantile(ms_10, 0.5);
  state.counters["p99_ms"] = quantile(ms_10, 0.99);
  state.counters["times_8_bits"] = quantile(ms_10, 0.5) / quantile(ms_8, 0.5);
}

void naive(benchmark::State& state) {
  const auto width = static_cast<int>(state.range(0));
  const Pan& scene = pan(width);
  const double min_distance_px = kMinDistance_px * scene.height() / spidar::kReferenceHeight_px;
  cv::setNumThreads(1);
  cv::Mat before;
  double tracked = 0;
  const double ms = run(state, scene, [&](const ImageView& frame, int) {
    const cv::Mat now(frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.data),
                      static_cast<size_t>(frame.stride_bytes));
    if (!before.empty()) {
      std::vector<cv::Point2f> from;
      std::vector<cv::Point2f> to;
      std::vector<uint8_t> found;
      std::vector<float> error;
      cv::goodFeaturesToTrack(before, from, kFeatures, kQuality, min_distance_px);
      cv::calcOpticalFlowPyrLK(before, now, from, to, found, error, cv::Size(21, 21), 3);
      tracked += static_cast<double>(std::count(found.begin(), found.end(), 1));
    }
    before = now;
  });
  state.counters["tracked"] = tracked / static_cast<double>(state.iterations());
  const double analyzer = analyzer_ms()[width];
  if (analyzer > 0) state.counters["times_slower"] = ms / analyzer;
}

/// DIS of half the size, preset medium; the frames are halved on the way, as a caller would.
void dis(benchmark::State& state) {
  const auto width = static_cast<int>(state.range(0));
  cv::setNumThreads(1);
  const cv::Ptr<cv::DISOpticalFlow> flow_of =
      cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM);
  cv::Mat before;
  cv::Mat flow;
  const double ms = run(state, pan(width), [&](const ImageView& frame, int) {
    const cv::Mat whole(frame.height, frame.width, CV_8U, const_cast<uint8_t*>(frame.data),
                        static_cast<size_t>(frame.stride_bytes));
    cv::Mat now;
    cv::resize(whole, now, {}, 0.5, 0.5, cv::INTER_AREA);
    if (!before.empty()) flow_of->calc(before, now, flow);
    before = now;
  });
  const double analyzer = analyzer_ms()[width];
  if (analyzer > 0) state.counters["times_slower"] = ms / analyzer;
}

void sizes(benchmark::internal::Benchmark* b) {
  b->Unit(benchmark::kMillisecond)->Arg(640)->Arg(1280)->Arg(1920)->Arg(3840);
}

BENCHMARK(analyze)->Apply(sizes)->Iterations(300);
BENCHMARK(analyze_10_bits)->Apply(sizes)->Iterations(300);
BENCHMARK(naive)->Apply(sizes)->Iterations(30);
BENCHMARK(dis)->Apply(sizes)->Iterations(15);

}  // namespace

BENCHMARK_MAIN();
