// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Whether the true velocity of an object is within the bound that comes with it.
#include "core/analysis/motion_analyzer.h"
#include "core/motion/objects/object_motion.h"
#include "core/quantile.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"

namespace spidar::test::error_bound_test {
namespace {

using Eigen::Vector2d;

constexpr int kWidth = 640;
constexpr int kHeight = 360;
constexpr int64_t kFrame_ns = 40'000'000;
constexpr double kFrame_s = 0.04;

struct Frame {
  double error_px;  ///< distance of the measured motion from the true one
  double bound_px;
};

constexpr int kFilmFrames = 12;

/// A disc before a wall, and what a camera makes of them.
struct DiscFilm {
  std::function<Vector2d(double n)> disc_px;  ///< in frame n, from the middle of the picture
  Vector2d pan_px{0, 0};                      ///< of the wall, a frame
  double fraction = 0.08;                     ///< of the picture
  double noise_grey = 1.5;                    ///< of a good camera's sensor
  double turn_rad = 0;                        ///< of the disc, a frame
  double shutter = 0;                         ///< of the time between frames
  double darkens = 0;                         ///< fraction of the light that a frame lacks more
  double cell_px = 8;                ///< of the textures; a camera out of focus has large ones
  MovingScene::Skin skin = nullptr;  ///< of the disc, if it is no texture
};

/// By `step_px` a frame, through the middle of the picture halfway.
std::function<Vector2d(double)> crossing(const Vector2d& step_px) {
  return [=](double n) { return Vector2d((n - (kFilmFrames - 1) / 2.0) * step_px); };
}

/// The frames in which a film's only object is found.
std::vector<Frame> frames_of(const DiscFilm& film, uint32_t seed = 1) {
  const double radius_px = std::sqrt(film.fraction * kWidth * kHeight / M_PI);
  MovingScene scene(kWidth, kHeight, seed, film.cell_px);
  film.skin ? scene.add_disc(radius_px, film.skin) : scene.add_disc(radius_px);
  const auto disc = [&](double n) { return Placement{film.disc_px(n), 1, film.turn_rad * n}; };
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, film.noise_grey);
  std::vector<Frame> frames;
  MotionAnalyzer analyzer;
  Picture picture(kWidth, kHeight);
  for (int n = 0; n < kFilmFrames; ++n) {
    // Less than a pixel from one to the next at 16 px a frame and half of the time.
    const int exposures = film.shutter > 0 ? 9 : 1;
    std::vector<double> exposed(picture.pixels.size());
    for (int k = 0; k < exposures; ++k) {
      const double time = n + film.shutter * ((k + 0.5) / exposures - 0.5);
      const ImageView view = scene.draw({time * film.pan_px}, {disc(time)});
      for (size_t i = 0; i < exposed.size(); ++i) exposed[i] += view.data[i] / (1.0 * exposures);
    }
    auto grey = exposed.begin();
    picture.fill([&](double, double) {
      const double lit = *grey++ * (1 - film.darkens * n) + 70 * film.darkens * n;
      return std::clamp(lit + noise(random), 0.0, 255.0);
    });
    for (const MovingObject& object : analyzer.analyze(picture.view(), n * kFrame_ns).objects) {
      const Vector2d on_disc = disc(n).on_thing(object.position_px);
      if (object.points == 0 || on_disc.norm() > radius_px) continue;
      const Placement before = disc(n - 1);
      const Vector2d from_px = before.centre_px + Eigen::Rotation2Dd(before.angle_rad) * on_disc;
      const Vector2d true_px = object.position_px - from_px - film.pan_px;
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

TEST(ErrorBound, HoldsInNineteenOfTwentyFrames) {
  const auto at_speed = [](double px) { return crossing(px * Vector2d(3, 1).normalized()); };
  const DiscFilm pan{crossing({9, 2.5}), {-4, 1.5}};
  DiscFilm turns{crossing({7, -2})}, noisy = pan, soft = pan, blurred{at_speed(16)}, darker = pan;
  turns.turn_rad = 3 * M_PI / 180;
  noisy.noise_grey = 6;
  soft.cell_px = 24;
  blurred.shutter = 0.5;
  darker.darkens = 0.03;
  std::vector<Frame> all;
  for (const DiscFilm& film :
       {DiscFilm{[](double n) { return Vector2d(-60 + 10 * n + 6 * std::sin(n), 0); }},
        DiscFilm{at_speed(2)}, DiscFilm{at_speed(11)}, DiscFilm{at_speed(26)}, pan, turns, noisy,
        soft, blurred, darker, DiscFilm{crossing({10, 3}), {0, 0}, 0.01}}) {
    // SPIDAR_SWEEP=1: the figure of docs/tracking.md, half a minute.
    const unsigned films = std::getenv("SPIDAR_SWEEP") ? 25 : 1;
    for (unsigned seed = 1; seed <= films; ++seed) {
      const std::vector<Frame> frames = frames_of(film, seed);
      EXPECT_GE(frames.size(), 8u) << "seed " << seed;
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
DiscFilm striped_object(double across, double noise_grey) {
  DiscFilm film{crossing({4, 4}), {0, 0}, 0.02, noise_grey};
  film.skin = [across](const Vector2d& at_px) {
    return 128 + across * std::sin(at_px.x() / 4) + 50 * std::sin(at_px.y() / 4);
  };
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
  const std::vector<Frame> frames =
      frames_of({[](double n) { return Vector2d(-30 + 6 * std::min(n, 6.0), 0); }});
  ASSERT_GE(frames.size(), 8u);
  EXPECT_EQ(frames.back().error_px, 0);
  EXPECT_GT(frames.back().bound_px, 0);
  // Smaller than the least motion that is told from rest: three standard deviations, not 2.4.
  EXPECT_LT(frames.back().bound_px, 0.25 * 1.5 * kErrorSigmas);
}

}  // namespace
}  // namespace spidar::test::error_bound_test
