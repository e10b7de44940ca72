// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Whether "only what a scene needs" pays: models of the camera's motion, on displacements whose
/// true order is known, with noise, and a third of them an object's. How often each order is
/// chosen by the GRIC, and by AIC and BIC on the same fits; the error of the displacement over the
/// picture, px, and the time of a frame, with what is chosen, and with a homography for all. The
/// element itself stands beside them: it also keeps a model from frame to frame.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/camera/background.h"
#include "core/motion/camera/motion_models.h"
#include "tests/bench/benchmarks.h"
#include "tests/bench/call_timer.h"
#include "tests/support/random_motion.h"

namespace {

using namespace spidar;
using Eigen::Vector2d;

const Vector2d kSize_px(427, 240);  // of the picture in which motion is measured
constexpr int kColumns = 26, kRows = 15;
constexpr double kNoise_px = kUsualNoise_px;
constexpr int kFrames = 40, kScenes = 50;

/// What a camera in a hand does in a frame: at the borders, each new parameter moves by some px.
MotionModel motion_of(ModelKind kind, test::RandomMotion& random) {
  MotionModel model;
  model.kind = kind;
  const auto some = [&](double most) { return random.uniform(-most, most); };
  if (kind >= ModelKind::kTranslation) model.shift_px = {some(6), some(6)};
  if (kind >= ModelKind::kSimilarity) {
    const double grow = some(0.02), turn = some(0.02);
    model.linear << grow, -turn, turn, grow;
  }
  if (kind >= ModelKind::kAffine) {
    const double stretch = some(0.02), shear = some(0.02);
    model.linear(0, 0) += stretch;
    model.linear(1, 1) -= stretch;
    model.linear(0, 1) += shear;
    model.linear(1, 0) += shear;
  }
  if (kind == ModelKind::kHomography) model.perspective_1_px = {some(1e-4), some(1e-4)};
  return model;
}

/// A third of the picture is an object that moves by itself.
BackgroundVotes votes_of(const MotionModel& truth, const Vector2d& object_px, int every,
                         test::RandomMotion& random) {
  BackgroundVotes votes;
  votes.size_px = kSize_px;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const Vector2d at_px = kSize_px.cwiseProduct(Vector2d((column + 0.5) / kColumns - 0.5,  //
                                                            (row + 0.5) / kRows - 0.5));
      if ((row * kColumns + column) % every != 0) continue;
      const bool at_border = row == 0 || column == 0 || row == kRows - 1 || column == kColumns - 1;
      const bool is_objects = row >= 3 && row < 12 && column >= 6 && column < 20;
      const double angle = random.uniform(0, 2 * M_PI);
      const double size = kNoise_px * std::sqrt(-2 * std::log(1 - random.uniform(0, 1)));
      Vector2d moved_px =
          truth.displacement_px(at_px) + size * Vector2d(std::cos(angle), std::sin(angle));
      if (is_objects) moved_px += object_px;
      votes.cast.push_back({{at_px, moved_px}, 1, at_border, votes.cast.size()});
    }
  }
  votes.all = votes.sum();
  return votes;
}

double error_px(const MotionModel& model, const MotionModel& truth) {
  double sum = 0;
  for (const double x : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
    for (const double y : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
      const Vector2d at_px = kSize_px.cwiseProduct(Vector2d(x, y));
      sum += (model.displacement_px(at_px) - truth.displacement_px(at_px)).squaredNorm();
    }
  }
  return std::sqrt(sum / 25);
}

using Fits = std::array<std::optional<MotionModel>, kModelKinds>;

/// Index of the chosen fit.
using Choice = std::function<int(const Fits&, const WeightedDisplacements&)>;

Choice by_price(std::function<double(int kind, size_t points)> price) {
  return [price](const Fits& fits, const WeightedDisplacements& evidence) {
    int best = 0;
    double least = INFINITY;
    for (int kind = 0; kind < kModelKinds; ++kind) {
      const auto& fit = fits[static_cast<size_t>(kind)];
      const double total =
          fit ? robust_cost(*fit, evidence) + price(kind, evidence.points.size()) : INFINITY;
      if (total < least) least = total, best = kind;
    }
    return best;
  };
}

struct Way {
  const char* name;
  bool fits_all;  ///< every order is fitted, and one is chosen
  Choice choose;
};

/// Prices of Torr's GRIC (background.h), and Akaike's and Schwarz's criteria with 2 n coordinates.
const std::vector<Way>& ways() {
  static const std::vector<Way> all = {
      {"GRIC", true, by_price([](int kind, size_t n) {
         return std::log(4.0 * static_cast<double>(n)) * 2 * kind;
       })},
      {"AIC", true, by_price([](int kind, size_t) { return 2.0 * 2 * kind; })},
      {"BIC", true, by_price([](int kind, size_t n) {
         return std::log(2.0 * static_cast<double>(n)) * 2 * kind;
       })},
      {"always homography", false,
       [](const Fits&, const WeightedDisplacements&) {
         return static_cast<int>(ModelKind::kHomography);
       }},
  };
  return all;
}

struct Row {
  std::array<int, kModelKinds> chosen{};
  std::vector<double> error_px, us;
};

void print(const std::string& name, const Row& row) {
  std::printf("| %s |", name.c_str());
  const double frames = static_cast<double>(row.error_px.size());
  for (const int n : row.chosen) std::printf(" %.0f |", 100 * n / frames);
  std::printf(" %.3f | %.3f | ", bench::quantile(row.error_px, 0.5),
              bench::quantile(row.error_px, 0.95));
  std::printf("%.0f |\n", bench::quantile(row.us, 0.5));
}

void measure(ModelKind truth_kind, int every) {
  std::printf("\n### true order: %s, %d displacements\n\n| |", to_string(truth_kind),
              (kColumns * kRows + every - 1) / every);
  for (int kind = 0; kind < kModelKinds; ++kind)
    std::printf(" %s, %% |", to_string(static_cast<ModelKind>(kind)));
  std::printf(" error, px | 95 %% | µs |\n|---|---|---|---|---|---|---|---|---|\n");
  Row element;
  std::vector<Row> rows(ways().size());
  for (int scene = 0; scene < kScenes; ++scene) {
    test::RandomMotion random(static_cast<uint64_t>(scene) + 1);
    const Vector2d object_px(random.uniform(-8, 8), random.uniform(-8, 8));
    const MotionModel truth = motion_of(truth_kind, random);
    BackgroundEstimator estimator;
    for (int frame = 0; frame < kFrames; ++frame) {
      const BackgroundVotes votes = votes_of(truth, object_px, every, random);
      const double begin_ns = bench::now_ns();
      const Background& found = estimator.store(estimator.propose(votes));
      element.us.push_back(1e-3 * (bench::now_ns() - begin_ns));
      estimator.learn_noise(votes, [](size_t) { return false; });
      ++element.chosen[static_cast<size_t>(found.model.kind)];
      element.error_px.push_back(error_px(found.model, truth));

      WeightedDisplacements evidence;
      for (const BackgroundVote& vote : votes.cast) {
        evidence.points.push_back(vote.point);
        evidence.weights.push_back(vote.votes());
      }
      evidence.sigma_px = kNoise_px;
      Fits fits;
      const double start_ns = bench::now_ns();
      const MotionModel start = find_start(evidence, {MotionModel()});
      const double start_us = 1e-3 * (bench::now_ns() - start_ns);
      std::array<double, kModelKinds> us{};
      for (size_t kind = 0; kind < kModelKinds; ++kind) {
        const double fit_ns = bench::now_ns();
        fits[kind] =
            kind == 0 ? MotionModel() : fit_robustly(static_cast<ModelKind>(kind), start, evidence);
        us[kind] = 1e-3 * (bench::now_ns() - fit_ns);
      }
      for (size_t w = 0; w < rows.size(); ++w) {
        const auto kind = static_cast<size_t>(ways()[w].choose(fits, evidence));
        ++rows[w].chosen[kind];
        rows[w].error_px.push_back(error_px(fits[kind].value_or(start), truth));
        rows[w].us.push_back(start_us + (ways()[w].fits_all
                                             ? std::accumulate(us.begin(), us.end(), 0.0)
                                             : us[kind]));
      }
    }
  }
  print("element", element);
  for (size_t w = 0; w < rows.size(); ++w) print(ways()[w].name, rows[w]);
}

}  // namespace

int spidar::bench::ladder(int, char**) {
  std::printf("%d scenes of %d frames, with a noise of %.2f px\n", kScenes, kFrames, kNoise_px);
  for (const int every : {1, 11}) {
    for (int kind = 0; kind < kModelKinds; ++kind) measure(static_cast<ModelKind>(kind), every);
  }
  return 0;
}
