// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Whether the true velocity of an object is within the bound that comes with it.
#include "core/analysis/motion_analyzer.h"
#include "core/motion/objects/object_motion.h"
#include "core/quantile.h"
#include "tests/support/film_studio.h"
#include "tests/support/motion_cases.h"
#include "tests/support/test.h"

namespace spidar::test::error_bound_test {
namespace {

using Eigen::Affine2d;
using Eigen::Translation2d;
using Eigen::Vector2d;

constexpr int kWidth = 640;
constexpr int kHeight = 360;
constexpr int64_t kFrame_ns = 40'000'000;
constexpr double kFrame_s = 0.04;

struct Frame {
  double error_px;  ///< distance of the measured motion from the true one
  double bound_px;
};

/// The frames in which a film's only object is found.
std::vector<Frame> frames_of(Film film) {
  std::vector<Frame> frames;
  MotionAnalyzer analyzer;
  const FilmObject& truth = film.objects.at(0);
  for (int n = 0; n < kFilmFrames; ++n) {
    const spidar::Frame found = analyzer.analyze(film.draw(n), n * kFrame_ns);
    for (const MovingObject& object : found.objects) {
      const Vector2d on_object = truth.pose(n).inverse() * object.position_px;
      if (object.points == 0 || on_object.norm() > truth.radii_px.x()) continue;
      const Vector2d from_px = truth.pose(n - 1) * on_object + film.middle_px();
      const Vector2d true_px = film.object_displacement_px(n, truth, from_px);
      frames.push_back(
          {(object.relative_px_s * kFrame_s - true_px).norm(), object.error_px_s * kFrame_s});
    }
  }
  return frames;
}

double median_bound_px(const std::vector<Frame>& frames) {
  std::vector<double> bounds;
  for (const Frame& frame : frames) bounds.push_back(frame.bound_px);
  return bounds.empty() ? 0 : median(bounds);
}

/// Goes to the right and swings while it does.
Film swinging_object() {
  FilmStudio studio(kWidth, kHeight, 1);
  Film film = studio.still_film();
  film.noise = 1.5;
  film.objects = {studio.object(FilmStudio::kFraction, [](double t) {
    return Affine2d(Translation2d(-60 + 10 * t + 6 * std::sin(t), 0));
  })};
  return film;
}

TEST(ErrorBound, HoldsInNineteenOfTwentyFrames) {
  std::vector<Frame> all = frames_of(swinging_object());
  for (const char* name : {"slow-object", "object", "fast-object", "pan-object", "rotating-object",
                           "noise", "blur", "motion-blur", "brightness", "tiny-object"}) {
    // SPIDAR_SWEEP=1: the figure of docs/tracking.md, half a minute.
    const unsigned films = std::getenv("SPIDAR_SWEEP") ? 25 : 1;
    for (unsigned seed = 1; seed <= films; ++seed) {
      const std::vector<Frame> frames = frames_of(motion_case(name, kWidth, kHeight, seed));
      EXPECT_GE(frames.size(), 8u) << name << ", seed " << seed;
      all.insert(all.end(), frames.begin(), frames.end());
    }
  }
  const auto n = static_cast<double>(all.size());
  const auto missed = std::count_if(
      all.begin(), all.end(), [](const Frame& frame) { return frame.error_px > frame.bound_px; });
  std::printf("the bound held in %.1f %% of %.0f frames\n",
              100 - 100 * static_cast<double>(missed) / n, n);
  // Of n frames, a bound that holds in 95 % is missed in 0.05 n; three standard deviations of it.
  EXPECT_LE(static_cast<double>(missed), 0.05 * n + 3 * std::sqrt(0.05 * 0.95 * n)) << n;
  // Blocks are accurate to a tenth of a pixel of the field's picture, of which one is 1.5 px here;
  // the bound of the error of one block would be this.
  EXPECT_LT(median_bound_px(all), kErrorSigmas * 0.1 * 1.5);
}

/// A small object whose picture has contrast `across` in x and 50 grey levels in y.
Film striped_object(double across, double noise) {
  FilmStudio studio(kWidth, kHeight, 2);
  Film film = studio.still_film();
  film.noise = noise;
  FilmObject object = studio.object(0.02, studio.crossing({4, 4}));
  const auto stripes = std::make_shared<SplineSheet>(256, 256);
  stripes->fill([across](double x, double y) {
    return 128 + across * std::sin(x / 4) + 50 * std::sin(y / 4);
  });
  object.sheet = stripes;
  film.objects = {object};
  return film;
}

TEST(ErrorBound, IsLargerAlongAnEdgeAndInNoise) {
  const double usual_px = median_bound_px(frames_of(striped_object(50, 1.5)));
  ASSERT_GT(usual_px, 0);
  EXPECT_GT(median_bound_px(frames_of(striped_object(12, 1.5))), usual_px);
  EXPECT_GT(median_bound_px(frames_of(striped_object(50, 6))), usual_px);
}

/// Bound of a thing of `side` × `side` blocks, all of which agree on its motion, in a picture with
/// contrast `across` in x, 50 grey levels in y and noise of σ = 3.
double bound_of_blocks_px(double across, int side) {
  BlockField field;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 3);
  for (int n = 0; n < 2; ++n) {
    PaddedImage picture;
    picture.resize(320, 240);
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        const double grey = 128 + across * std::sin(x / 4.0) + 50 * std::sin(y / 4.0);
        picture.row(y)[x] = static_cast<uint8_t>(grey + noise(random));
      }
    }
    picture.repeat_border();
    field.update(picture);
  }
  std::vector<RelativeBlock> relative(field.blocks().size());
  std::vector<uint32_t> owners(relative.size());
  for (size_t i = 0; i < owners.size(); ++i) {
    relative[i].shows_motion = true;
    owners[i] = field.grid().column(i) < side && field.grid().row(i) < side;
  }
  ObjectMotion found;
  found.model.kind = ModelKind::kTranslation;
  return ErrorBound().px(1, Region(), found, {field, relative, owners, {}, Background()});
}

TEST(ErrorBound, BlocksOfAnEdgeAgreeAndAreUnsureAllTheSame) {
  EXPECT_GT(bound_of_blocks_px(0, 1), 2 * bound_of_blocks_px(50, 1));
  // A sum of what all blocks share and of a part that falls with their number: 1, 1/4, 1/16.
  // That of one block has a standard error of √(2 · 2 / 256) = 12 % from its residual and its
  // texture, that of four 6 % of a difference that is 3/4 of it: together 14 %, and three of them.
  const auto variance = [](int side) { return std::pow(bound_of_blocks_px(0, side), 2); };
  const double falls = (variance(1) - variance(4)) / (variance(2) - variance(4));
  EXPECT_NEAR(falls, 5, 3 * 0.14 * 5);
}

TEST(ErrorBound, AnObjectThatStopsIsAtRestWithinTheNoise) {
  FilmStudio studio(kWidth, kHeight, 3);
  Film film = studio.still_film();
  film.noise = 1.5;
  film.objects = {studio.object(FilmStudio::kFraction, [](double t) {
    return Affine2d(Translation2d(-30 + 6 * std::min(t, 6.0), 0));
  })};
  const std::vector<Frame> frames = frames_of(film);
  ASSERT_GE(frames.size(), 8u);
  EXPECT_EQ(frames.back().error_px, 0);
  EXPECT_GT(frames.back().bound_px, 0);
  // Smaller than the least motion that is told from rest: three standard deviations, not 2.4.
  EXPECT_LT(frames.back().bound_px, 0.25 * 1.5 * kErrorSigmas);
}

}  // namespace
}  // namespace spidar::test::error_bound_test
