// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The ladder of models of the camera's motion: each rung where it is needed, where a lower one
// would do, and where it is too low, beside the rung that BackgroundEstimator chooses. The
// error of a model is in px, rms over the picture and 800 frames of 300 votes.
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/background.h"
#include "tests/bench/call_timer.h"
#include "tests/core/track_samples.h"

namespace {

using spidar::BackgroundVotes;
using spidar::Displacement;
using spidar::kModelKinds;
using spidar::ModelKind;
using spidar::MotionModel;
using spidar::test::TrackSource;

constexpr int kScenes = 100;  // seeds
constexpr int kFrames = 8;    // of each scene, with the same motion
constexpr int kVotes = 300;
constexpr double kSigma_px = 0.13;  // of a block's displacement
/// An object with a fifth of the votes.
constexpr int kObjectVotes = kVotes / 5;
constexpr double kObject_px = 6;
constexpr double kObjectSide_px = 120;

/// One scene: the camera's true motion, and what blocks measure of it in each frame.
struct Scene {
  MotionModel truth;
  std::array<BackgroundVotes, kFrames> frames;
};

/// The sample model in a random strength and direction.
MotionModel random_model(ModelKind kind, TrackSource& source) {
  MotionModel model = spidar::test::sample_model(kind);
  const double strength = source.uniform(0.3, 1.5);
  const double turn = source.uniform(-M_PI, M_PI);
  const Eigen::Matrix2d rotation{{std::cos(turn), -std::sin(turn)},
                                 {std::sin(turn), std::cos(turn)}};
  model.shift_px = strength * rotation * model.shift_px;
  model.linear = strength * rotation * model.linear * rotation.transpose();
  model.perspective_1_px = strength * rotation * model.perspective_1_px;
  return model;
}

void add_vote(BackgroundVotes& votes, const Displacement& point) {
  votes.points.push_back(point);
  votes.weights.push_back(1);
  votes.at_border.push_back(0);
  votes.sources.push_back(votes.sources.size());
}

BackgroundVotes votes_of(const MotionModel& truth, bool with_object, TrackSource& source) {
  BackgroundVotes votes;
  votes.size_px << source.width(), source.height();
  votes.all = kVotes;
  const int background = with_object ? kVotes - kObjectVotes : kVotes;
  for (const Displacement& point : source.moved(truth, background, kSigma_px)) {
    add_vote(votes, point);
  }
  const Eigen::Vector2d moves_px(kObject_px, 0);
  for (int i = background; i < kVotes; ++i) {
    const double x_px = source.uniform(-kObjectSide_px, kObjectSide_px) / 2;
    const double y_px = source.uniform(-kObjectSide_px, kObjectSide_px) / 2;
    Displacement point = source.moved(truth, {x_px, y_px}, kSigma_px);
    point.moved_px += moves_px;
    add_vote(votes, point);
  }
  return votes;
}

std::vector<Scene> scenes_of(ModelKind kind, bool with_object) {
  std::vector<Scene> scenes(kScenes);
  for (size_t n = 0; n < scenes.size(); ++n) {
    TrackSource source(static_cast<uint32_t>(n + 1));
    scenes[n].truth = random_model(kind, source);
    for (BackgroundVotes& votes : scenes[n].frames) {
      votes = votes_of(scenes[n].truth, with_object, source);
    }
  }
  return scenes;
}

/// Mean squared distance over the picture between where two models move it.
double square_error_px2(const MotionModel& model, const MotionModel& truth,
                        const Eigen::Vector2d& size_px) {
  constexpr int kPlaces = 9;
  double sum = 0;
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    const Eigen::Vector2d share((i % kPlaces + 0.5) / kPlaces - 0.5,
                                (i / kPlaces + 0.5) / kPlaces - 0.5);
    const Eigen::Vector2d at_px = share.cwiseProduct(size_px);
    sum += (model.displacement_px(at_px) - truth.displacement_px(at_px)).squaredNorm();
  }
  return sum / (kPlaces * kPlaces);
}

/// What a way to find the model reached over all frames of the scenes.
struct Result {
  double error_px = 0;   ///< root mean square over frames and picture
  double median_us = 0;  ///< of a frame
  std::array<int, kModelKinds> rungs{};
};

/// `find(votes)` returns the model of a frame; `begin()` is called before each scene.
template <typename Begin, typename Find>
Result measure(const std::vector<Scene>& scenes, Begin&& begin, Find&& find) {
  Result result;
  std::vector<double> times_us;
  double sum_px2 = 0;
  for (const Scene& scene : scenes) {
    begin();
    for (const BackgroundVotes& votes : scene.frames) {
      const double start_ns = spidar::bench::now_ns();
      const MotionModel model = find(votes);
      times_us.push_back(1e-3 * (spidar::bench::now_ns() - start_ns));
      sum_px2 += square_error_px2(model, scene.truth, votes.size_px);
      ++result.rungs[static_cast<size_t>(model.kind)];
    }
  }
  result.error_px = std::sqrt(sum_px2 / static_cast<double>(times_us.size()));
  result.median_us = spidar::bench::quantile(times_us, 0.5);
  return result;
}

/// One rung in every frame, whatever the scene needs, from the same start as the estimator's.
Result forced(ModelKind kind, const std::vector<Scene>& scenes) {
  spidar::RobustFitter fitter;
  spidar::WeightedDisplacements evidence;
  std::vector<MotionModel> known;
  return measure(
      scenes, [&] { known.assign(2, MotionModel()); },
      [&](const BackgroundVotes& votes) {
        evidence.points = votes.points;
        evidence.weights = votes.weights;
        evidence.sigma_px = 0.3;  // BackgroundEstimator's, with its least noise
        const MotionModel start = fitter.start(evidence, known);
        known[1] = fitter.refine(kind, start, evidence).value_or(MotionModel());
        return known[1];
      });
}

Result chosen(const std::vector<Scene>& scenes) {
  spidar::BackgroundEstimator estimator;
  return measure(
      scenes, [&] { estimator.reset(); },
      [&](const BackgroundVotes& votes) {
        const MotionModel model = estimator.estimate(votes).model;
        estimator.learn_noise(votes, [](size_t) { return false; });
        return model;
      });
}

}  // namespace

int main() {
  spidar::bench::pin_to_one_core();
  std::printf(
      "| the scene needs | still | translation | similarity | affine | homography | chosen | right "
      "rung %% |\n"
      "|---|---|---|---|---|---|---|---|\n");
  std::array<double, kModelKinds + 1> worst_us{};
  for (const bool with_object : {false, true}) {
    for (int needed = 0; needed < kModelKinds; ++needed) {
      const auto kind = static_cast<ModelKind>(needed);
      const std::vector<Scene> scenes = scenes_of(kind, with_object);
      std::printf("| %s%s |", to_string(kind), with_object ? ", and an object" : "");
      for (int rung = 0; rung < kModelKinds; ++rung) {
        const Result result = forced(static_cast<ModelKind>(rung), scenes);
        auto& us = worst_us[static_cast<size_t>(rung)];
        us = std::max(us, result.median_us);
        std::printf(" %.3f |", result.error_px);
      }
      const Result result = chosen(scenes);
      worst_us.back() = std::max(worst_us.back(), result.median_us);
      const double all = kScenes * kFrames;
      std::printf(" %.3f | %.1f |\n", result.error_px,
                  100 * result.rungs[static_cast<size_t>(kind)] / all);
    }
  }
  std::printf("| microseconds a frame |");
  for (const double us : worst_us) std::printf(" %.0f |", us);
  std::printf(" |\n");
}
