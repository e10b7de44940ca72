// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Microseconds from the picture to the motion that is felt, by the motion of the camera and the
// number of objects: the cost depends on the rungs, objects and points that a scene needs.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/motion/motion_estimator.h"
#include "tests/support/moving_scene.h"
#include "tests/support/picture.h"

namespace {

using spidar::ImageView;
using spidar::ModelKind;
using spidar::MotionEstimator;
using spidar::ReducedFrame;
using spidar::test::MovingScene;
using spidar::test::Picture;
using spidar::test::Placement;

constexpr int kWidth = 640;
constexpr int kHeight = 360;
constexpr int kFrames = 16;  // there and back again
constexpr int64_t kFrame_ns = 33'333'333;

/// Of a camera that does what `kind` can, up to the similarity.
Placement camera(ModelKind kind, int n) {
  Placement placement;
  if (kind >= ModelKind::kTranslation) placement.centre_px = {3.0 * n, -1.5 * n};
  if (kind >= ModelKind::kSimilarity) {
    placement.scale = 1 + 0.01 * n;
    placement.angle_rad = 0.01 * n;
  }
  return placement;
}

std::vector<Picture> draw(ModelKind kind, int objects) {
  MovingScene scene(kWidth, kHeight);
  for (int k = 0; k < objects; ++k) scene.add_disc(50);
  std::vector<Picture> frames;
  for (int n = 0; n < kFrames; ++n) {
    const int t = std::min(n, kFrames - n);
    std::vector<Placement> discs;
    for (int k = 0; k < objects; ++k) {
      discs.push_back({{-200.0 + 180 * k + (4 + k) * t, 60.0 - 10 * t}});
    }
    const ImageView view = scene.draw(camera(kind, t), discs);
    Picture copy(view.width, view.height);
    for (int y = 0; y < view.height; ++y) {
      std::memcpy(copy.pixels.data() + y * copy.stride, view.data + y * view.stride_bytes,
                  static_cast<size_t>(view.width));
    }
    frames.push_back(std::move(copy));
  }
  return frames;
}

void run(benchmark::State& state, ModelKind kind, int objects) {
  const std::vector<Picture> frames = draw(kind, objects);
  MotionEstimator estimator;
  ReducedFrame reduced;
  spidar::MeasuredFrame scene;
  size_t n = 0;
  double found = 0;
  for (auto _ : state) {
    const ImageView frame = frames[n++ % frames.size()].view();
    reduced.read(frame);
    scene.forget_motion();
    scene.interval_ns = kFrame_ns;
    if (estimator.estimate(frame, reduced, {}, scene))
      found += static_cast<double>(scene.objects.size());
  }
  state.counters["objects"] = found / static_cast<double>(state.iterations());
}

}  // namespace

int main(int argc, char** argv) {
  for (const ModelKind kind :
       {ModelKind::kStill, ModelKind::kTranslation, ModelKind::kSimilarity}) {
    for (const int objects : {0, 1, 3}) {
      const std::string name =
          std::string(spidar::to_string(kind)) + "/objects:" + std::to_string(objects);
      benchmark::RegisterBenchmark(name.c_str(), run, kind, objects)->Unit(benchmark::kMicrosecond);
    }
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
