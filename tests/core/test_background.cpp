// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The model of the background from many votes; and whether few are its own, those of objects in
// front of a plain one, or unknown.
#include "core/field/block_kernels.h"
#include "core/motion/camera/background.h"
#include "point_samples.h"
#include "tests/support/test.h"

namespace spidar::test::background_test {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 360;
/// Of a block's displacement.
constexpr double kSigma_px = 0.13;

/// Each point has one vote, two at the border, out of those of a picture with `blocks`.
BackgroundVotes votes(const std::vector<Displacement>& points, int blocks = 250) {
  constexpr double kBorder_px = 32;
  BackgroundVotes votes;
  votes.size_px << kWidth, kHeight;
  votes.all = blocks;
  for (const Displacement& point : points) {
    const Eigen::Vector2d from_middle_px = point.at_px.cwiseAbs();
    const bool at_border = from_middle_px.x() > kWidth / 2 - kBorder_px ||
                           from_middle_px.y() > kHeight / 2 - kBorder_px;
    const double weight = at_border ? kBorderVotes : 1;
    votes.cast.push_back({point, weight, at_border, votes.cast.size()});
  }
  return votes;
}

Background estimate(BackgroundEstimator& estimator, const BackgroundVotes& votes) {
  return estimator.store(estimator.propose(votes));
}

Background settle(BackgroundEstimator& estimator, PointSource& source, const MotionModel& truth,
                  int frames, double sigma_px, int strays = 0) {
  Background background;
  for (int n = 0; n < frames; ++n) {
    auto points = source.moved(truth, 200 - strays, sigma_px);
    for (int i = 0; i < strays; ++i) points.push_back(source.stray());
    const BackgroundVotes given = votes(points);
    background = estimate(estimator, given);
    estimator.learn_noise(given, [](size_t) { return false; });
  }
  return background;
}

class EachModelKind : public testing::TestWithParam<ModelKind> {};

TEST_P(EachModelKind, IsTheOneThatThePointsNeed) {
  const MotionModel truth = sample_model(GetParam());
  for (const int strays : {0, 40}) {
    for (uint32_t seed = 1; seed <= 10; ++seed) {
      PointSource source(seed);
      BackgroundEstimator estimator;
      for (int n = 0; n < 20; ++n) {
        const Background found = settle(estimator, source, truth, 1, kSigma_px, strays);
        // From the first frame on, and without ever changing.
        ASSERT_EQ(to_string(found.model.kind), std::string(to_string(truth.kind)))
            << "seed " << seed << ", frame " << n << ", strays " << strays;
        // 160 points at least; eight parameters share 2 · 160 equations, so that a displacement
        // has on average σ √(8 / 320) = 0.16 σ of noise in each coordinate, and in a corner, where
        // the leverage of a homography's points is largest, up to five times that; 4 deviations.
        for (const Eigen::Vector2d& at : {Eigen::Vector2d(0, 0), Eigen::Vector2d(300, 160)}) {
          EXPECT_LT((found.model.displacement_px(at) - truth.displacement_px(at)).norm(),
                    4 * 5 * 0.16 * kSigma_px)
              << "seed " << seed << ", frame " << n;
        }
      }
    }
  }
}

TEST_P(EachModelKind, FallsToStillWhenTheCameraStops) {
  PointSource source(3);
  BackgroundEstimator estimator;
  settle(estimator, source, sample_model(GetParam()), 5, kSigma_px);
  // At most four models, five frames each.
  const Background found = settle(estimator, source, MotionModel(), 4 * 5, kSigma_px);
  EXPECT_EQ(found.model.kind, ModelKind::kStill);
  EXPECT_EQ(found.model.displacement_px({100, 100}), Eigen::Vector2d(0, 0));
}

INSTANTIATE_TEST_SUITE_P(Hierarchy, EachModelKind,
                         testing::Values(ModelKind::kStill, ModelKind::kTranslation,
                                         ModelKind::kSimilarity, ModelKind::kAffine,
                                         ModelKind::kHomography),
                         [](const auto& instance) {
                           return std::string(to_string(instance.param));
                         });

TEST(Background, DoesNotFlickerWhereTwoRungsAreEquallyGood) {
  // A pan so slow that the gain of GRIC is about the price of its parameters: n |t|² / 2σ² ≈ 2 λ₂.
  // Without hysteresis every other frame would change the model.
  PointSource source(7);
  BackgroundEstimator estimator;
  MotionModel slow;
  slow.kind = ModelKind::kTranslation;
  slow.shift_px << kSigma_px * std::sqrt(2 * std::log(4.0 * 200) / 200), 0;
  int changes = 0;
  ModelKind last = ModelKind::kStill;
  for (int n = 0; n < 300; ++n) {
    const Background found = settle(estimator, source, slow, 1, kSigma_px);
    changes += found.model.kind != last;
    last = found.model.kind;
    EXPECT_LE(found.model.kind, ModelKind::kTranslation) << "frame " << n;
  }
  // Five better frames in succession, each with a chance of about a half, come about once in 62.
  EXPECT_LE(changes, 2 * 300 / 62);
}

TEST(Background, IsFoundInTheFirstFrameInWhichItIsVisibleAgain) {
  // A camera so fast that every block is wrong, for longer and shorter than climbing waits.
  MotionModel pan;
  pan.kind = ModelKind::kTranslation;
  pan.shift_px << -9, 2;
  for (int lost = 1; lost <= 8; ++lost) {
    PointSource source(static_cast<uint32_t>(lost));
    BackgroundEstimator estimator;
    settle(estimator, source, pan, 5, kSigma_px);
    settle(estimator, source, pan, lost, kSigma_px, 200);
    pan.shift_px = -pan.shift_px;
    const Background found = settle(estimator, source, pan, 1, kSigma_px);
    EXPECT_EQ(found.model.kind, ModelKind::kTranslation) << lost << " frames";
    // 200 points that do not count alike, at worst as 100.
    EXPECT_LT((found.model.shift_px - pan.shift_px).norm(), 5 * kSigma_px / std::sqrt(100.0));
  }
}

TEST(Background, LearnsTheNoiseOfBadVideo) {
  PointSource source(9);
  BackgroundEstimator estimator;
  const double sigma_px = 0.3 * 640 / 480;
  const Background still = settle(estimator, source, MotionModel(), 40, sigma_px);
  // A median of 200 residuals is right to 6 %; three times that.
  EXPECT_NEAR(still.sigma_px, sigma_px, 0.18 * sigma_px);
  const MotionModel pan = sample_model(ModelKind::kTranslation);
  const Background moving = settle(estimator, source, pan, 5, sigma_px);
  EXPECT_EQ(moving.model.kind, ModelKind::kTranslation);
}

TEST(Background, AFastCameraIsFoundBesideAnObjectThatMovesAsOne) {
  // Points move by 5 px on average otherwise than the best similarity says, and by 16 px in a
  // corner, so that the similarity with which most of them agree exactly is the object's.
  MotionModel truth = sample_model(ModelKind::kHomography);
  truth.shift_px *= 1.5;
  truth.linear *= 1.5;
  truth.perspective_1_px *= 1.5;
  for (uint32_t seed = 1; seed <= 40; ++seed) {
    PointSource source(seed);
    auto points = source.moved(truth, 240, kSigma_px);
    for (int i = 0; i < 60; ++i) {
      const double x_px = source.uniform(-60, 60);
      points.push_back(source.moved(truth, {x_px, source.uniform(-60, 60)}, kSigma_px));
      points.back().moved_px.x() += 6;
    }
    BackgroundEstimator estimator;
    const Background found = estimate(estimator, votes(points));
    EXPECT_EQ(found.model.kind, ModelKind::kHomography) << "seed " << seed;
    // As above, of 240 points: √(8 / 480) = 0.13 σ.
    for (const Eigen::Vector2d& at : {Eigen::Vector2d(0, 0), Eigen::Vector2d(300, 160)}) {
      EXPECT_LT((found.model.displacement_px(at) - truth.displacement_px(at)).norm(),
                4 * 5 * 0.13 * kSigma_px)
          << "seed " << seed;
    }
  }
}

TEST(SparseVotes, OfEdgesDoNotMakeItUnknown) {
  // Coding errors around an object in front of a plain wall have edges.
  PointSource source(11);
  BackgroundEstimator estimator;
  std::vector<Displacement> points;
  for (int i = 0; i < 200; ++i) points.push_back(source.stray());
  BackgroundVotes given = votes(points);
  EXPECT_FALSE(estimate(estimator, given).is_known);
  given.with_edges = true;
  EXPECT_TRUE(estimate(estimator, given).is_known);
}

TEST(SparseVotes, OfAPictureThatIsLostDoNotSayThatTheCameraRests) {
  for (const int count : {4, 50}) {
    PointSource source(12);
    BackgroundEstimator estimator;
    std::vector<Displacement> points;
    for (int i = 0; i < count; ++i) points.push_back(source.stray());
    BackgroundVotes given = votes(points, 900);
    EXPECT_TRUE(estimate(estimator, given).is_known) << count << " votes before a plain wall";
    given.are_lost = true;
    EXPECT_FALSE(estimate(estimator, given).is_known) << count;
    points.clear();
    for (int i = 0; i < count; ++i) {
      points.push_back(source.moved(MotionModel(), source.stray().at_px, kSigma_px));
    }
    given = votes(points, 900);
    given.are_lost = true;
    EXPECT_EQ(estimate(estimator, given).is_known, count == 50) << count << " that rest";
  }
}

/// So many blocks that all below are few.
constexpr int kPlainBlocks = 2000;

/// Points a block apart, wherever `is_there` holds, that move by `moved_px`.
template <typename IsThere>
std::vector<Displacement> connected(const Eigen::Vector2d& moved_px, IsThere&& is_there) {
  std::vector<Displacement> points;
  for (int row = 0; row < kHeight / kBlock_px; ++row) {
    for (int column = 0; column < kWidth / kBlock_px; ++column) {
      const double x = kBlock_px * (column - (kWidth / kBlock_px - 1) / 2.0);
      const double y = kBlock_px * (row - (kHeight / kBlock_px - 1) / 2.0);
      if (is_there(x, y)) points.push_back({{x, y}, moved_px});
    }
  }
  return points;
}

TEST(SparseVotes, ThatAreConnectedAreOfOneThingUnlessItIsCutByTwoBorders) {
  // Each covers more than an object usually does.
  const auto person = [](double x, double y) { return std::abs(x) < 130 && y > -90; };
  const auto boards_above_ice = [](double, double y) { return y < -90; };
  const auto ground_at_a_slope = [](double x, double y) { return x < 2 * y - 50; };
  const auto kind_of = [](auto&& is_there) {
    BackgroundEstimator estimator;
    const Background found = estimate(estimator, votes(connected({4, 1}, is_there), kPlainBlocks));
    EXPECT_TRUE(found.is_known);
    return found.model.kind;
  };
  EXPECT_EQ(kind_of(person), ModelKind::kStill);
  EXPECT_EQ(kind_of(boards_above_ice), ModelKind::kTranslation);
  EXPECT_EQ(kind_of(ground_at_a_slope), ModelKind::kTranslation);
}

TEST(SparseVotes, OfALargeThingDoNotMakeItUnknown) {
  // A person who fills half of the picture before a plain wall, and the motion of whose arms agrees
  // with nothing.
  std::vector<Displacement> points =
      connected({4, 1}, [](double x, double y) { return std::abs(x) < 200 && y > -120; });
  PointSource source(3);
  for (int i = 0; i < 10; ++i) points.push_back(source.stray());
  BackgroundEstimator estimator;
  const Background found = estimate(estimator, votes(points, kPlainBlocks));
  EXPECT_EQ(found.model.kind, ModelKind::kStill);
  EXPECT_TRUE(found.is_known);
}

}  // namespace
}  // namespace spidar::test::background_test
