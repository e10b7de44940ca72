// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/motion/camera/motion_models.h"
#include "core/motion/camera/robust_fit.h"
#include "track_samples.h"

namespace spidar::test::motion_models_test {
namespace {

using test::sample_model;
using test::TrackSource;

std::vector<double> ones(size_t n) {
  return std::vector<double>(n, 1.0);
}

/// t, A by rows, h: as many as the kind has.
std::vector<double*> free_numbers(MotionModel& m) {
  switch (m.kind) {
    case ModelKind::kStill:
      return {};
    case ModelKind::kTranslation:
      return {&m.shift_px[0], &m.shift_px[1]};
    case ModelKind::kSimilarity:  // A(1, 1) and A(0, 1) follow
      return {&m.shift_px[0], &m.shift_px[1], &m.linear(0, 0), &m.linear(1, 0)};
    case ModelKind::kAffine:
      return {&m.shift_px[0],  &m.shift_px[1],  &m.linear(0, 0),
              &m.linear(0, 1), &m.linear(1, 0), &m.linear(1, 1)};
    case ModelKind::kHomography:
      return {&m.shift_px[0],  &m.shift_px[1],  &m.linear(0, 0),        &m.linear(0, 1),
              &m.linear(1, 0), &m.linear(1, 1), &m.perspective_1_px[0], &m.perspective_1_px[1]};
  }
  return {};
}

void complete(MotionModel& m) {
  if (m.kind != ModelKind::kSimilarity) return;
  m.linear(1, 1) = m.linear(0, 0);
  m.linear(0, 1) = -m.linear(1, 0);
}

/// Smallest variances that an unbiased estimate can have: σ² (JᵀJ)⁻¹, J by central differences.
Eigen::VectorXd cramer_rao(const MotionModel& truth, const std::vector<Displacement>& points,
                           double sigma_px) {
  const auto n = static_cast<Eigen::Index>(points.size());
  const int k = parameters(truth.kind);
  Eigen::MatrixXd jacobian(2 * n, k);
  for (int j = 0; j < k; ++j) {
    const double h = 1e-7;
    MotionModel plus = truth, minus = truth;
    *free_numbers(plus)[static_cast<size_t>(j)] += h;
    *free_numbers(minus)[static_cast<size_t>(j)] -= h;
    complete(plus);
    complete(minus);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Vector2d& at = points[static_cast<size_t>(i)].at_px;
      jacobian.block<2, 1>(2 * i, j) =
          (plus.displacement_px(at) - minus.displacement_px(at)) / (2 * h);
    }
  }
  return sigma_px * sigma_px * (jacobian.transpose() * jacobian).inverse().diagonal();
}

class EachModel : public testing::TestWithParam<ModelKind> {};

TEST_P(EachModel, IsFoundExactlyWithoutNoise) {
  const MotionModel truth = sample_model(GetParam());
  TrackSource source(1);
  const auto points = source.moved(truth, 40, 0);
  const auto found = fit_model(GetParam(), points, ones(points.size()));
  ASSERT_TRUE(found);
  // Rounding of a few hundred operations on numbers of a few hundred px; Gauss–Newton squares its
  // error four times.
  for (const auto& p : points) {
    EXPECT_LT((found->displacement_px(p.at_px) - p.moved_px).norm(), 1e-9);
  }
}

TEST_P(EachModel, ReachesTheCramerRaoBound) {
  const MotionModel truth = sample_model(GetParam());
  const int k = parameters(truth.kind);
  constexpr int kRuns = 400;
  constexpr double kSigma_px = 0.1;
  TrackSource places(2);
  const auto exact = places.moved(truth, 60, 0);
  const Eigen::VectorXd bound = cramer_rao(truth, exact, kSigma_px);
  Eigen::VectorXd square = Eigen::VectorXd::Zero(k);
  for (int run = 0; run < kRuns; ++run) {
    TrackSource noise(100 + static_cast<uint32_t>(run));
    auto points = exact;
    for (auto& p : points) p.moved_px += noise.noise_px(kSigma_px);
    auto found = fit_model(truth.kind, points, ones(points.size()));
    ASSERT_TRUE(found) << "seed " << 100 + run;
    MotionModel expected = truth;
    for (size_t j = 0; j < static_cast<size_t>(k); ++j) {
      const double error = *free_numbers(*found)[j] - *free_numbers(expected)[j];
      square[static_cast<Eigen::Index>(j)] += error * error / kRuns;
    }
  }
  // The mean of 400 squares of Gaussians is right to √(2 / 400) = 7 %; five times that.
  for (Eigen::Index j = 0; j < k; ++j) {
    EXPECT_NEAR(square[j] / bound[j], 1, 5 * std::sqrt(2.0 / kRuns)) << "parameter " << j;
  }
}

/// All but the camera that stands still, of which nothing is to be found.
class EachMovingModel : public testing::TestWithParam<ModelKind> {};

TEST_P(EachMovingModel, TakesWeights) {
  const ModelKind kind = GetParam();
  TrackSource source(3);
  const MotionModel truth = sample_model(kind);
  auto points = source.moved(truth, 30, 0);
  auto weights = ones(points.size());
  for (int i = 0; i < 30; ++i) {
    points.push_back(source.stray());
    weights.push_back(0);
  }
  const auto found = fit_model(kind, points, weights);
  ASSERT_TRUE(found);
  EXPECT_LT((found->displacement_px({100, 50}) - truth.displacement_px({100, 50})).norm(), 1e-9);
}

std::optional<MotionModel> fit_robustly(ModelKind kind, const WeightedDisplacements& evidence) {
  RobustFitter fitter;
  return fitter.refine(kind, fitter.start(evidence, {}), evidence);
}

TEST_P(EachModel, IsFoundAmongEquallyManyOutliers) {
  const ModelKind kind = GetParam();
  const MotionModel truth = sample_model(kind);
  constexpr double kSigma_px = 0.1;
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    TrackSource source(seed);
    WeightedDisplacements evidence;
    evidence.points = source.moved(truth, 100, kSigma_px);
    const Eigen::VectorXd bound = cramer_rao(truth, evidence.points, kSigma_px);
    for (int i = 0; i < 100; ++i) evidence.points.push_back(source.stray());
    evidence.weights = ones(evidence.points.size());
    // As the background's estimator has it: outliers begin at six times the noise of good pictures.
    evidence.sigma_px = 3 * kSigma_px;
    auto found = fit_robustly(kind, evidence);
    ASSERT_TRUE(found) << "seed " << seed;
    // The weights of Geman and McClure with a reach of 6 σ cost 2 % of what is known: numerically,
    // E[w² e²] / E[(w e)′]² = 1.02 for w = 1 / (1 + e² / 36 σ²)² in the plane. The largest of 160
    // deviations is below 4 σ with 99 %. Strays within the reach are one in 3000.
    MotionModel expected = truth;
    for (size_t j = 0; j < free_numbers(expected).size(); ++j) {
      const double error = *free_numbers(*found)[j] - *free_numbers(expected)[j];
      EXPECT_LT(std::abs(error), 4 * std::sqrt(1.02 * bound[static_cast<Eigen::Index>(j)]))
          << "seed " << seed << ", parameter " << j;
    }
    const auto again = fit_robustly(kind, evidence);
    EXPECT_EQ(again->shift_px, found->shift_px);
    EXPECT_EQ(again->linear, found->linear);
    EXPECT_EQ(again->perspective_1_px, found->perspective_1_px);
  }
}

TEST_P(EachModel, NeedsItsPoints) {
  const ModelKind kind = GetParam();
  TrackSource source(4);
  const auto enough = static_cast<size_t>(parameters(kind) / 2);  // each gives two equations
  const auto points = source.moved(sample_model(kind), static_cast<int>(enough), 0);
  EXPECT_TRUE(fit_model(kind, points, ones(enough)));
  if (enough == 0) return;
  const std::vector<Displacement> fewer(points.begin(), points.end() - 1);
  EXPECT_FALSE(fit_model(kind, fewer, ones(enough - 1)));
  EXPECT_FALSE(fit_robustly(kind, {fewer, ones(enough - 1), 0.1}));
}

std::string name_of(const testing::TestParamInfo<ModelKind>& instance) {
  return to_string(instance.param);
}

INSTANTIATE_TEST_SUITE_P(Ladder, EachModel,
                         testing::Values(ModelKind::kStill, ModelKind::kTranslation,
                                         ModelKind::kSimilarity, ModelKind::kAffine,
                                         ModelKind::kHomography),
                         name_of);

INSTANTIATE_TEST_SUITE_P(Ladder, EachMovingModel,
                         testing::Values(ModelKind::kTranslation, ModelKind::kSimilarity,
                                         ModelKind::kAffine, ModelKind::kHomography),
                         name_of);

TEST(MotionModels, PointsOnALineDoNotDetermineAnAffineModel) {
  TrackSource source(5);
  std::vector<Displacement> line;
  const MotionModel still;
  for (int i = 0; i < 20; ++i) line.push_back(source.moved(still, {10.0 * i, 5.0 * i}, 0.1));
  EXPECT_TRUE(fit_model(ModelKind::kSimilarity, line, ones(20)));
  EXPECT_FALSE(fit_model(ModelKind::kAffine, line, ones(20)));
  EXPECT_FALSE(fit_model(ModelKind::kHomography, line, ones(20)));
  EXPECT_FALSE(fit_robustly(ModelKind::kHomography, {line, ones(20), 0.1}));
}

TEST(MotionModels, PointsInOnePlaceDetermineAShiftOnly) {
  // 0.1 and 0.2 have no exact mean.
  for (const Eigen::Vector2d& at_px : {Eigen::Vector2d(10, 10), Eigen::Vector2d(0.1, 0.2)}) {
    std::vector<Displacement> points(5, {0, at_px, {1, 2}});
    points.push_back({0, at_px, {1.5, 2}});
    const std::vector<double> weights = {1, 0.7, 0.1, 0.3, 0.9, 0.2};
    const double mean_x_px = 1 + 0.5 * 0.2 / 3.2;
    const MotionModel shift = fit_model(ModelKind::kTranslation, points, weights).value();
    EXPECT_NEAR(shift.shift_px.x(), mean_x_px, 1e-12);
    EXPECT_NEAR(shift.shift_px.y(), 2, 1e-12);
    EXPECT_FALSE(fit_model(ModelKind::kSimilarity, points, weights)) << at_px.transpose();
    EXPECT_FALSE(fit_model(ModelKind::kAffine, points, weights)) << at_px.transpose();
  }
}

TEST(MotionModels, GrowthAndRollAreThoseOfTheSimilarity) {
  MotionModel model;
  model.kind = ModelKind::kSimilarity;
  const double scale = 1.1, angle_rad = 0.2;
  model.linear << scale * std::cos(angle_rad) - 1, -scale * std::sin(angle_rad),
      scale * std::sin(angle_rad), scale * std::cos(angle_rad) - 1;
  EXPECT_NEAR(model.roll_rad(), angle_rad, 1e-12);
  // From the centre to the right, y down: clockwise is down.
  EXPECT_GT(model.displacement_px({100, 0}).y(), 0);
  EXPECT_NEAR(model.growth(), scale * std::cos(angle_rad) - 1, 1e-12);
}

TEST(MotionModels, DisplacementsAreAboutTheCentreAndBounded) {
  std::vector<Displacement> points;
  displacements({{7, {319.5f, 179.5f}, {320.5f, 181.5f}}}, 640, 360, points);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].id, 7u);
  EXPECT_EQ(points[0].at_px, Eigen::Vector2d(0, 0));
  EXPECT_EQ(points[0].moved_px, Eigen::Vector2d(1, 2));
  for (const size_t n : {size_t{1}, kMostDisplacements, kMostDisplacements + 1, size_t{10000}}) {
    displacements(std::vector<Track>(n), 640, 360, points);
    EXPECT_LE(points.size(), kMostDisplacements);
    EXPECT_GE(points.size(), std::min(n, kMostDisplacements / 2));
  }
  displacements({}, 640, 360, points);
  EXPECT_TRUE(points.empty());
}

}  // namespace
}  // namespace spidar::test::motion_models_test
