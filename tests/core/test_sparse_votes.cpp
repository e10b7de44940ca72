// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Whether few votes are the background's, those of objects in front of a plain one, or unknown.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "background_votes.h"

namespace spidar::test::sparse_votes_test {
namespace {

using namespace background_votes;

TEST(SparseVotes, OfOneOrTwoObjectsAreNotTheBackgrounds) {
  // Up to 100 of 900 each, far apart: some similarity explains any two of them.
  const std::vector<Eigen::Vector2d> positions_px{{-250, 100}, {250, 100}};
  const std::vector<Eigen::Vector2d> moved_px{{-3, 0}, {3, 0}};
  for (const int count : {50, 100})
    for (size_t objects = 1; objects <= positions_px.size(); ++objects) {
      TrackSource source(8);
      BackgroundEstimator estimator;
      for (int n = 0; n < 10; ++n) {
        std::vector<Displacement> points;
        for (size_t i = 0; i < objects; ++i) {
          add_object(source, points, count, positions_px[i], moved_px[i], kSigma_px);
        }
        const Background& found = estimator.estimate(votes(points, 900));
        EXPECT_EQ(found.model.kind, ModelKind::kStill)
            << objects << " objects of " << count << ", frame " << n;
        EXPECT_TRUE(found.is_known) << objects << " objects of " << count << ", frame " << n;
      }
    }
}

TEST(SparseVotes, ThatAgreeOnNothingAllOverThePictureMakeItUnknown) {
  TrackSource source(11);
  BackgroundEstimator estimator;
  settle(estimator, source, sample_model(ModelKind::kSimilarity), 5, kSigma_px);
  for (int n = 0; n < 10; ++n) {
    const Background found = settle(estimator, source, MotionModel(), 1, kSigma_px, 200);
    EXPECT_FALSE(found.is_known) << "frame " << n;
    EXPECT_EQ(found.coverage, 0) << "frame " << n;
  }
  EXPECT_TRUE(
      settle(estimator, source, sample_model(ModelKind::kSimilarity), 1, kSigma_px).is_known);
}

TEST(SparseVotes, OfEdgesDoNotMakeItUnknown) {
  // Coding errors around an object in front of a plain wall have edges.
  TrackSource source(11);
  BackgroundEstimator estimator;
  std::vector<Displacement> points;
  for (int i = 0; i < 200; ++i) points.push_back(source.stray());
  BackgroundVotes given = votes(points);
  EXPECT_FALSE(estimator.estimate(given).is_known);
  given.with_edges = true;
  EXPECT_TRUE(estimator.estimate(given).is_known);
}

TEST(SparseVotes, OfAPictureThatIsLostDoNotSayThatTheCameraRests) {
  for (const int count : {4, 50}) {
    TrackSource source(12);
    BackgroundEstimator estimator;
    std::vector<Displacement> points;
    for (int i = 0; i < count; ++i) points.push_back(source.stray());
    BackgroundVotes given = votes(points, 900);
    EXPECT_TRUE(estimator.estimate(given).is_known) << count << " votes before a plain wall";
    given.are_lost = true;
    EXPECT_FALSE(estimator.estimate(given).is_known) << count;
    points.clear();
    for (int i = 0; i < count; ++i) {
      points.push_back(source.moved(MotionModel(), source.stray().at_px, kSigma_px));
    }
    given = votes(points, 900);
    given.are_lost = true;
    EXPECT_EQ(estimator.estimate(given).is_known, count == 50) << count << " that rest";
  }
}

TEST(SparseVotes, InManyPlacesAreEnough) {
  // 60 of 900, as of a sky with few clouds: 15 clouds of four points.
  for (const ModelKind kind : {ModelKind::kTranslation, ModelKind::kSimilarity}) {
    const MotionModel truth = sample_model(kind);
    for (uint32_t seed = 1; seed <= 10; ++seed) {
      TrackSource source(seed);
      BackgroundEstimator estimator;
      for (int n = 0; n < 5; ++n) {
        std::vector<Displacement> points;
        for (int i = 0; i < 60; ++i) {
          const Eigen::Vector2d cloud_px(-240 + 120 * (i % 5), -120 + 120 * (i / 5 % 3));
          const Eigen::Vector2d within_px(16 * (i / 15 % 2), 16 * (i / 30));
          points.push_back(source.moved(truth, cloud_px + within_px, kSigma_px));
        }
        const Background& found = estimator.estimate(votes(points, 900));
        EXPECT_EQ(found.model.kind, kind) << "seed " << seed << ", frame " << n;
        // 60 points: σ / √60 a coordinate, 5 deviations.
        EXPECT_LT((found.model.shift_px - truth.shift_px).norm(),
                  5 * kSigma_px * std::sqrt(2.0 / 60))
            << "seed " << seed << ", frame " << n;
      }
    }
  }
}

}  // namespace
}  // namespace spidar::test::sparse_votes_test
