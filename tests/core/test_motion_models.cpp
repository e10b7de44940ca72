// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/motion/camera/motion_models.h"
#include "point_samples.h"
#include "tests/support/test.h"

namespace spidar::test::motion_models_test {
namespace {

using test::PointSource;
using test::sample_model;

std::vector<double> ones(size_t n) {
  return std::vector<double>(n, 1.0);
}

/// Least squares: the weights are as they are where no error comes near the reach. Of a homography,
/// each fit is then one Gauss–Newton step.
std::optional<MotionModel> fit_model(ModelKind kind, const std::vector<Displacement>& points,
                                     const std::vector<double>& weights) {
  constexpr int kSteps = 5;
  constexpr double kReach_px = 1e7;
  std::optional<MotionModel> model = MotionModel();
  for (int step = 0; step < kSteps && model; ++step) {
    model = fit_robustly(kind, *model, {points, weights, kReach_px});
  }
  return model;
}

/// Σ (found − true)² / σ² over the displacements of the points. Of an efficient estimate of k
/// parameters from points with noise σ in each coordinate it is a χ² with k degrees of freedom:
/// k ± √(2k).
double squared_error(const MotionModel& found, const MotionModel& truth,
                     const std::vector<Displacement>& points, double sigma_px) {
  double sum = 0;
  for (const Displacement& p : points) {
    sum += (found.displacement_px(p.at_px) - truth.displacement_px(p.at_px)).squaredNorm();
  }
  return sum / (sigma_px * sigma_px);
}

class EachModel : public testing::TestWithParam<ModelKind> {};

TEST_P(EachModel, IsFoundExactlyWithoutNoise) {
  const MotionModel truth = sample_model(GetParam());
  PointSource source(1);
  const auto points = source.moved(truth, 40, 0);
  const auto found = fit_model(GetParam(), points, ones(points.size()));
  ASSERT_TRUE(found);
  // Rounding of a few hundred operations on numbers of a few hundred px; Gauss–Newton squares its
  // error four times.
  for (const auto& p : points) {
    EXPECT_LT((found->displacement_px(p.at_px) - p.moved_px).norm(), 1e-9);
  }
}

TEST_P(EachModel, IsEfficient) {
  const MotionModel truth = sample_model(GetParam());
  const int k = parameters(truth.kind);
  constexpr int kRuns = 400;
  constexpr double kSigma_px = 0.1;
  PointSource positions(2);
  const auto exact = positions.moved(truth, 60, 0);
  double mean = 0;
  for (int run = 0; run < kRuns; ++run) {
    PointSource noise(100 + static_cast<uint32_t>(run));
    auto points = exact;
    for (auto& p : points) p.moved_px += noise.noise_px(kSigma_px);
    const auto found = fit_model(truth.kind, points, ones(points.size()));
    ASSERT_TRUE(found) << "seed " << 100 + run;
    mean += squared_error(*found, truth, exact, kSigma_px) / kRuns;
  }
  EXPECT_NEAR(mean, k, 5 * std::sqrt(2.0 * k / kRuns));
}

std::optional<MotionModel> fit_robustly(ModelKind kind, const WeightedDisplacements& evidence) {
  return spidar::fit_robustly(kind, find_start(evidence, {}), evidence);
}

TEST_P(EachModel, IsFoundAmongEquallyManyOutliers) {
  const ModelKind kind = GetParam();
  const MotionModel truth = sample_model(kind);
  constexpr double kSigma_px = 0.1;
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    PointSource source(seed);
    WeightedDisplacements evidence;
    evidence.points = source.moved(truth, 100, kSigma_px);
    const auto inliers = evidence.points;
    for (int i = 0; i < 100; ++i) evidence.points.push_back(source.stray());
    evidence.weights = ones(evidence.points.size());
    // As the background's estimator has it: outliers begin at six times the noise of good pictures.
    evidence.sigma_px = 3 * kSigma_px;
    const auto found = fit_robustly(kind, evidence);
    ASSERT_TRUE(found) << "seed " << seed;
    // The weights of Geman and McClure with a reach of 6 σ cost 2 % of what is known: numerically,
    // E[w² e²] / E[(w e)′]² = 1.02 for w = 1 / (1 + e² / 36 σ²)² in the plane. Of the χ², k + 2 √(k
    // x)
    // + 2 x is exceeded with e^−x (Laurent and Massart, Ann. Statist. 28, 2000): once in 1e5 draws.
    // Strays within the reach are one in 3000.
    const double k = parameters(kind), x = std::log(1e5);
    EXPECT_LT(squared_error(*found, truth, inliers, kSigma_px),
              1.02 * (k + 2 * std::sqrt(k * x) + 2 * x))
        << "seed " << seed;
    const auto again = fit_robustly(kind, evidence);
    EXPECT_EQ(again->shift_px, found->shift_px);
    EXPECT_EQ(again->linear, found->linear);
    EXPECT_EQ(again->perspective_1_px, found->perspective_1_px);
  }
}

TEST_P(EachModel, NeedsItsPoints) {
  const ModelKind kind = GetParam();
  PointSource source(4);
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

INSTANTIATE_TEST_SUITE_P(Hierarchy, EachModel,
                         testing::Values(ModelKind::kStill, ModelKind::kTranslation,
                                         ModelKind::kSimilarity, ModelKind::kAffine,
                                         ModelKind::kHomography),
                         name_of);

TEST(MotionModels, PointsOnALineDoNotDetermineAnAffineModel) {
  PointSource source(5);
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
    std::vector<Displacement> points(5, {at_px, {1, 2}});
    points.push_back({at_px, {1.5, 2}});
    const std::vector<double> weights = {1, 0.7, 0.1, 0.3, 0.9, 0.2};
    const double mean_x_px = 1 + 0.5 * 0.2 / 3.2;
    const MotionModel shift = fit_model(ModelKind::kTranslation, points, weights).value();
    EXPECT_NEAR(shift.shift_px.x(), mean_x_px, 1e-12);
    EXPECT_NEAR(shift.shift_px.y(), 2, 1e-12);
    EXPECT_FALSE(fit_model(ModelKind::kSimilarity, points, weights)) << at_px.transpose();
    EXPECT_FALSE(fit_model(ModelKind::kAffine, points, weights)) << at_px.transpose();
  }
}

}  // namespace
}  // namespace spidar::test::motion_models_test
