// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Scenes in which little shows how the camera moves: whether what moves there is the camera or an
// object.
#include "core/analysis/motion_analyzer.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::sparse_scenes_test {
namespace {

using test::Picture;
using test::Texture;

constexpr int kWidth = 480;
constexpr int kHeight = 270;
constexpr int64_t kFrame_ns = 40'000'000;
constexpr double kFrame_s = 0.04;
constexpr int kFrames = 8;

/// Each frame shows a sky that the camera pans over by 4 px, and nothing else moves. `clouds`: the
/// sky has texture in small clouds only.
void expect_a_pan(double contrast, bool clouds) {
  constexpr double kMoved_px = 4;
  constexpr double kPeriod_px = 96;
  const Texture texture(3, 6);
  const auto from_cloud_px = [](double at_px) {
    return std::abs(std::remainder(at_px, kPeriod_px));
  };
  Picture picture(kWidth, kHeight);
  MotionAnalyzer analyzer;
  for (int n = 0; n < kFrames; ++n) {
    picture.fill([&](double x, double y) {
      const double u = x + kMoved_px * n;
      // A cloud is 32 px wide and fades out over 5 px.
      const double inside_px = clouds ? 16 - std::max(from_cloud_px(u), from_cloud_px(y)) : 5;
      return 128 + contrast * std::clamp(inside_px / 5, 0.0, 1.0) * (texture.at(u, y) - 128);
    });
    const Frame frame = analyzer.analyze(picture.view(), n * kFrame_ns);
    if (n == 0) continue;
    ASSERT_STREQ(to_string(frame.background->model.kind), "translation") << n;
    // To the tenth of a pixel that blocks are accurate to.
    EXPECT_NEAR(frame.background->model.shift_px.x(), -kMoved_px, 0.1) << n;
    EXPECT_TRUE(frame.objects.empty()) << n;
    EXPECT_EQ(frame.wrench.force_N.norm(), 0) << n;
  }
}

TEST(SparseScenes, FewCloudsShowHowTheCameraMoves) {
  expect_a_pan(0.5, true);
}

TEST(SparseScenes, AFaintSkyShowsHowTheCameraMoves) {
  expect_a_pan(0.3, false);
}

TEST(SparseScenes, EdgesShowHowTheCameraMovesWhereTheyAreAllThereIs) {
  // Stripes that are so wide that hardly any block sees more than one edge.
  constexpr double kMoved_px = 4;
  Picture picture(kWidth, kHeight);
  MotionAnalyzer analyzer;
  for (int n = 0; n < kFrames; ++n) {
    picture.fill([&](double x, double y) {
      const double u = x + kMoved_px * n;
      return 128 + 60 * std::tanh(8 * std::sin((u + 40 * std::sin(y / 60)) / 20));
    });
    const Frame frame = analyzer.analyze(picture.view(), n * kFrame_ns);
    if (n == 0) continue;
    ASSERT_STREQ(to_string(frame.background->model.kind), "translation") << n;
    // To the tenth of a pixel that blocks are accurate to.
    EXPECT_NEAR(frame.background->model.shift_px.x(), -kMoved_px, 0.1) << n;
    EXPECT_TRUE(frame.objects.empty()) << n;
  }
}

TEST(SparseScenes, NothingIsFeltWhereNothingAgreesHowTheCameraMoves) {
  // As on broken water, each tile of 32 px drifts by up to 8 px a frame in its own direction.
  constexpr int kTile_px = 32;
  const Texture texture(3, 6);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> drift_px(-8, 8);
  std::vector<Eigen::Vector2d> drifts_px((kWidth / kTile_px + 1) * (kHeight / kTile_px + 1));
  for (Eigen::Vector2d& each_px : drifts_px) each_px << drift_px(random), drift_px(random);
  Picture picture(kWidth, kHeight);
  MotionAnalyzer analyzer;
  for (int n = 0; n < kFrames; ++n) {
    picture.fill([&](double x, double y) {
      const auto tile = static_cast<size_t>(x) / kTile_px +
                        kWidth / kTile_px * (static_cast<size_t>(y) / kTile_px);
      const Eigen::Vector2d at_px = Eigen::Vector2d(x, y) - n * drifts_px[tile];
      return texture.at(at_px.x(), at_px.y());
    });
    const Frame frame = analyzer.analyze(picture.view(), n * kFrame_ns);
    if (n == 0) continue;
    EXPECT_EQ(frame.background->coverage, 0) << n;
    EXPECT_EQ(frame.wrench.force_N.norm(), 0) << n;
  }
}

TEST(SparseScenes, TheCameraRestsBehindASquareInACorner) {
  // It covers a seventh of a small picture, but more of its border.
  constexpr int kSide_px = 64;
  constexpr int kCell_px = 6;
  constexpr int kCells = kSide_px / kCell_px + 1;
  constexpr double kRadius_px = 17;
  constexpr double kTurn_rad = 4 / kRadius_px;  // 4 px a frame
  constexpr int kRests = 8;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> level(32, 224);
  std::normal_distribution<double> noise(0, 2);
  Eigen::Matrix<double, kCells, kCells> cells;
  for (double& cell : cells.reshaped()) cell = level(random);
  Picture picture(192, 144);
  MotionAnalyzer analyzer;
  for (int n = 0; n < 40; ++n) {
    const double angle_rad = kTurn_rad * std::max(0, n - kRests);
    const Eigen::Vector2d way(1 - std::cos(angle_rad), 1 + std::sin(angle_rad));
    const Eigen::Vector2i corner_px = (2 + (kRadius_px * way).array()).round().cast<int>();
    picture.fill([&](double x, double y) {
      const Eigen::Array2i on_px = Eigen::Vector2d(x, y).cast<int>() - corner_px;
      const bool is_its = on_px.minCoeff() >= 0 && on_px.maxCoeff() < kSide_px;
      const double grey = is_its ? cells(on_px.x() / kCell_px, on_px.y() / kCell_px) : 112;
      return std::clamp(grey + noise(random), 0.0, 255.0);
    });
    const Frame frame = analyzer.analyze(picture.view(), n * kFrame_ns);
    if (n == 0) continue;
    EXPECT_STREQ(to_string(frame.background->model.kind), "still") << n;
  }
}

}  // namespace
}  // namespace spidar::test::sparse_scenes_test
