// Microseconds that the motion of a frame takes once its 200 tracks are known, by what the camera
// does and how many objects there are: a scene pays for the rungs and objects that it has.
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/motion/motion_estimator.h"
#include "tests/core/track_samples.h"

namespace {

using spidar::Displacement;
using spidar::ModelKind;
using spidar::MotionEstimator;
using spidar::MotionKind;
using spidar::MotionModel;
using spidar::Track;
using spidar::test::sample_model;
using spidar::test::TrackSource;

constexpr int kWidth = 640;
constexpr int kHeight = 360;
constexpr int kTracks = 200;
constexpr int kOnObject = 16;  // 8 % of the tracks
constexpr int kFrames = 64;
constexpr double kNoise_px = 0.05;
constexpr int64_t kFrame_ns = 33'333'333;

using Frames = std::vector<std::vector<Track>>;

Track as_track(const Displacement& point, uint32_t id) {
  const Eigen::Vector2d from =
      point.at_px + Eigen::Vector2d((kWidth - 1) / 2.0, (kHeight - 1) / 2.0);
  const Eigen::Vector2f from_px = from.cast<float>();
  const Eigen::Vector2f to_px = (from + point.moved_px).cast<float>();
  return {id, {from_px.x(), from_px.y()}, {to_px.x(), to_px.y()}};
}

/// `kind` is the camera's; the objects are discs of 80 px that go up and down.
Frames make_frames(ModelKind kind, int objects) {
  TrackSource source(1);
  const MotionModel camera = sample_model(kind);
  Frames frames(kFrames);
  for (int n = 0; n < kFrames; ++n) {
    uint32_t id = 0;
    const auto add = [&](const Displacement& point) {
      frames[static_cast<size_t>(n)].push_back(as_track(point, id++));
    };
    for (int k = 0; k < objects; ++k) {
      MotionModel own;
      own.kind = ModelKind::kTranslation;
      own.shift_px << 4 + k, n % 16 < 8 ? 6 : -6;
      for (int i = 0; i < kOnObject; ++i) {
        const Eigen::Vector2d middle(-220 + 150 * k, 0);
        const double dx = source.uniform(-40, 40);
        add(source.moved(own, middle + Eigen::Vector2d(dx, source.uniform(-40, 40)), kNoise_px));
      }
    }
    while (frames[static_cast<size_t>(n)].size() < kTracks) {
      add(source.moved(camera, source.place_px(), kNoise_px));
    }
  }
  return frames;
}

void run(benchmark::State& state, MotionKind motion, ModelKind camera, int objects) {
  const Frames frames = make_frames(camera, objects);
  MotionEstimator estimator;
  size_t n = 0;
  double found = 0;
  for (auto _ : state) {
    const auto scene =
        estimator.estimate(motion, frames[n++ % kFrames], kWidth, kHeight, kFrame_ns);
    found += scene.objects;
  }
  state.counters["objects"] = found / static_cast<double>(state.iterations());
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::RegisterBenchmark("mean", run, MotionKind::kMean, ModelKind::kStill, 0)
      ->Unit(benchmark::kMicrosecond);
  for (int rung = 0; rung < spidar::kModelKinds; ++rung) {
    const auto camera = static_cast<ModelKind>(rung);
    for (const int objects : {0, 1, 3}) {
      const std::string name =
          std::string(spidar::to_string(camera)) + "/objects:" + std::to_string(objects);
      benchmark::RegisterBenchmark(name.c_str(), run, MotionKind::kObject, camera, objects)
          ->Unit(benchmark::kMicrosecond);
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
