// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The statistics of compare_controllers.
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "apps/feel/analyzed_film.h"
#include "apps/feel/figures.h"
#include "core/analysis/frame_renderer.h"
#include "core/force/motion_rendering.h"
#include "tests/core/motion_rows.h"
#include "tests/support/temporary_folder.h"

namespace spidar {
namespace {

/// A few dozen operations on numbers near 1.
constexpr double kRounding = 1e-12;
constexpr double kFrame_s = 0.04;
constexpr FilterSettings kNoFilter{0, 0};

Film film_of(const std::vector<double>& speeds_px_s, int height = 480) {
  Film film;
  film.height = height;
  film.frames.push_back({});  // the first frame shows no motion
  for (const double speed : speeds_px_s) {
    FilmFrame frame;
    frame.interval_s = kFrame_s;
    frame.motion.velocity_px_s.x() = speed;
    film.frames.push_back(frame);
  }
  return film;
}

TEST(AnalyzedFilm, IsTheMotionThatIsFeltWhileTheFilmIsMeasured) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path / "clip.avi.motion";
  const test::MeasuredFilm measured = test::random_film(3, 300);
  std::ofstream(path, std::ios::binary) << measured.file();
  ASSERT_TRUE(is_analysis(path));
  EXPECT_FALSE(is_analysis("clip.avi"));
  const AnalyzerSettings settings;
  const Film film = read_analysis(path, settings);
  EXPECT_EQ(film.name, "clip.avi");
  FrameRenderer live;
  size_t frames = 0;
  for (size_t i = 0; i < measured.frames.size(); ++i) {
    const MotionMoment& moment = measured.moments[i];
    if (moment.kind != MomentKind::kFrame) continue;
    AnalyzerSettings coded = settings;
    coded.pointer = moment.turn.place_coded(settings.pointer);
    live.configure(coded);
    MeasuredFrame frame = measured.frames[i];
    const FrameAnalysis felt = live.render(frame, {moment.stream_ns, moment.turn});
    ASSERT_LT(frames, film.frames.size());
    EXPECT_EQ(film.frames[frames].motion.velocity_px_s, felt.motion.velocity_px_s) << i;
    EXPECT_EQ(film.frames[frames].interval_s, 1e-9 * static_cast<double>(felt.interval_ns)) << i;
    EXPECT_EQ(film.height, felt.height);
    ++frames;
  }
  EXPECT_EQ(film.frames.size(), frames);
}

std::string problem_of(const std::string& path) {
  try {
    read_analysis(path, {});
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(AnalyzedFilm, SaysWhatIsWrong) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path / "clip.motion";
  EXPECT_EQ(problem_of(path), path + ": it cannot be opened");
  std::ofstream(path) << "no analysis";
  EXPECT_EQ(problem_of(path).find(path + ": "), 0u);
  MotionHeader mean;
  mean.is_mean = true;
  std::ofstream(path, std::ios::binary) << test::random_film(3, 10).file(mean);
  EXPECT_EQ(problem_of(path), path + ": " + wrong_motion(mean, MotionKind::kObject));
}

TEST(RankCorrelation, DependsOnOrderOnlyAndSharesRanks) {
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {-5, 0, 1, 1000}), 1, kRounding);
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {9, 7, 5, 3}), -1, kRounding);
  // Ranks 1 2 3 4 and 1.5 1.5 3 4: Σ about 2.5 is 4.5, squares are 5 and 4.5.
  EXPECT_NEAR(rank_correlation({1, 2, 3, 4}, {7, 7, 8, 9}), 4.5 / std::sqrt(5 * 4.5), kRounding);
  EXPECT_EQ(rank_correlation({1, 2, 3}, {5, 5, 5}), 0);
  EXPECT_EQ(rank_correlation({}, {}), 0);
}

TEST(FeelFigures, AreSharesOfTheTimeInWhichSomethingMoves) {
  // α V = 0.01 V: 1.5 px/s has 0.029 N and is not felt, 100 px/s has half of 3 N. The limit is
  // reached at tan(0.95 π / 2) / α = 1271 px/s.
  const Film film = film_of({0, 0, 1.5, 100, 104, 2000, 2000, 0});
  const FeelFigures f = feel(film, kNoFilter, {ControllerKind::kNonlinear, 3, 0.01});
  EXPECT_NEAR(f.moving, 5.0 / 8, kRounding);
  EXPECT_NEAR(f.felt, 4.0 / 5, kRounding);
  EXPECT_NEAR(f.at_limit, 2.0 / 5, kRounding);
  // From 1.5 to 100 and from 104 to 2000; 0 to 1.5 is less than is felt, 100 to 104 less than 10 %.
  EXPECT_NEAR(f.told_apart, 2.0 / 5, kRounding);
  EXPECT_NEAR(f.rank, 1, kRounding);
}

TEST(FeelFigures, DoNotDependOnTheSizeOfTheFrame) {
  const ControllerSettings settings;
  const FeelFigures small = feel(film_of({5, 50, 20, 10}, 240), {}, settings);
  const FeelFigures large = feel(film_of({20, 200, 80, 40}, 960), {}, settings);
  EXPECT_NEAR(small.mean_force_N, large.mean_force_N, kRounding);
  EXPECT_NEAR(small.told_apart, large.told_apart, kRounding);
}

TEST(FeelFigures, OfAStillFilmAreZero) {
  const FeelFigures f = feel(film_of({0, 0, 0}), {}, {});
  EXPECT_EQ(f.moving, 0);
  EXPECT_EQ(f.felt, 0);
  EXPECT_EQ(f.rank, 0);
}

}  // namespace
}  // namespace spidar
