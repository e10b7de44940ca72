// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Causes of wrong motion on real films, each in a film made for it.
#include "core/analysis/motion_analyzer.h"
#include "tests/support/scene_film.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::film_causes_test {
namespace {

using Eigen::Vector2d;
using test::in_disc;
using test::Picture;
using test::Scene;
using test::Texture;

/// An object is felt from the second pair of frames in which it moves.
constexpr int kFelt = 3;

std::vector<Frame> analyze(const Scene& scene, int frames) {
  MotionAnalyzer analyzer;
  std::vector<Frame> found;
  for (int n = 0; n < frames; ++n) {
    const Picture picture = test::draw(scene, n);
    found.push_back(analyzer.analyze(picture.view(), n * test::kSceneFrame_ns));
  }
  return found;
}

Vector2d moved_px(const Frame& frame) {
  return frame.motion.velocity_px_s * test::kSceneFrame_s;
}

/// Right as in the benchmark of real films: within 30 degrees and a factor of 2.
void expect_right(const Frame& frame, const Vector2d& true_px, int n) {
  const Vector2d found_px = moved_px(frame);
  ASSERT_GT(found_px.norm(), 0.5 * true_px.norm()) << "frame " << n;
  EXPECT_LT(found_px.norm(), 2 * true_px.norm()) << "frame " << n;
  EXPECT_GT(found_px.dot(true_px), std::cos(0.5236) * found_px.norm() * true_px.norm())
      << "frame " << n << ": " << found_px.transpose();
}

void expect_right(const Scene& scene, int frames, const std::function<Vector2d(int)>& true_px,
                  int first = kFelt) {
  const std::vector<Frame> found = analyze(scene, frames);
  for (int n = first; n < frames; ++n) expect_right(found[static_cast<size_t>(n)], true_px(n), n);
}

/// Nothing is felt from frame `first` on.
void expect_rest(const Scene& scene, int frames, int first = kFelt) {
  const std::vector<Frame> found = analyze(scene, frames);
  for (int n = first; n < frames; ++n) {
    EXPECT_EQ(moved_px(found[static_cast<size_t>(n)]), Vector2d(0, 0)) << "frame " << n;
  }
}

const Texture& background() {
  static const Texture texture(1, 10);
  return texture;
}
const Texture& foreground() {
  static const Texture texture(2, 10);
  return texture;
}

TEST(FilmCauses, AJointedBodyMovesAsItsTrunk) {
  // A trunk with four limbs that swing as it goes.
  const auto trunk = [](int n) { return Vector2d(150.0 + 6 * n, 180); };
  expect_right(
      [&](int n, const Vector2d& at) {
        const Vector2d from = at - trunk(n);
        if (std::abs(from.x()) < 40 && std::abs(from.y()) < 60) {
          return foreground().at(from.x(), from.y());
        }
        for (int limb = 0; limb < 4; ++limb) {
          const double side = limb % 2 == 0 ? -1 : 1;
          const double swing_px = 4 * std::sin(0.8 * n + limb);
          const Vector2d middle(side * 60, (limb < 2 ? -40 : 40) + swing_px);
          if (((from - middle).array().abs() < Vector2d(20, 12).array()).all()) {
            return foreground().at(from.x(), from.y() - swing_px);
          }
        }
        return background().at(at.x(), at.y());
      },
      24, [](int) { return Vector2d(6, 0); });
}

TEST(FilmCauses, ABodyThatSlowsDownIsFollowed) {
  // In front of a panning camera it slows down to a speed that would be too low for a new object.
  const auto trunk_px = [](int n) { return n < 10 ? 3.0 * n : 30 + 0.6 * (n - 10); };
  const Vector2d pan_px(-2, 0);
  expect_right(
      [&](int n, const Vector2d& at) {
        const Vector2d behind = at - n * pan_px;
        const Vector2d from = behind - Vector2d(300 + trunk_px(n), 160);
        const bool inside = std::abs(from.x()) < 110 && std::abs(from.y()) < 70;
        return inside ? foreground().at(from.x(), from.y())
                      : background().at(behind.x(), behind.y());
      },
      24, [&](int n) { return Vector2d(trunk_px(n) - trunk_px(n - 1), 0); });
}

TEST(FilmCauses, LayersOfASceneAreNoObjectsWhileTheCameraMoves) {
  // A hedge in front of a field: the camera moves sideways, and the hedge moves faster in the
  // picture.
  expect_rest(
      [](int n, const Vector2d& at) {
        if (at.y() > 290) return foreground().at(at.x() + 9.0 * n, at.y());
        return background().at(at.x() + 5.0 * n, at.y());
      },
      20);
}

TEST(FilmCauses, ABushThatIsALittleNearerIsNoObject) {
  // It touches no border, and goes as the background does, 18 % faster.
  expect_rest(
      [](int n, const Vector2d& at) {
        if (in_disc(at, {560.0 - 9.44 * n, 200}, 60)) {
          return foreground().at(at.x() + 9.44 * n, at.y());
        }
        return background().at(at.x() + 8.0 * n, at.y());
      },
      20);
}

TEST(FilmCauses, AStoneAtTheBorderIsNoObject) {
  // The whole visible part is at the border of the picture, so its extent is unknown.
  expect_rest(
      [](int n, const Vector2d& at) {
        if (at.y() > 338 && std::abs(at.x() - 560 + 13.0 * n) < 36) {
          return foreground().at(at.x() + 13.0 * n, at.y());
        }
        return background().at(at.x() + 8.0 * n, at.y());
      },
      20);
}

TEST(FilmCauses, WhatAFastCameraBringsIntoThePictureIsNoObject) {
  // Two blocks a frame enter at the side; a wall beside the camera moves faster than the scene.
  expect_rest(
      [](int n, const Vector2d& at) {
        if (at.x() < 120) return foreground().at(at.x() - 66.0 * n, at.y());
        return background().at(at.x() - 44.0 * n, at.y());
      },
      16);
}

TEST(FilmCauses, ASkyWithoutTextureIsNoBackground) {
  // The upper half is plain; a disc crosses it while the camera pans.
  expect_right(
      [](int n, const Vector2d& at) {
        if (in_disc(at, {150.0 + 5 * n, 100}, 50)) {
          return foreground().at(at.x() - 5.0 * n, at.y());
        }
        return at.y() < 180 ? 180.0 : background().at(at.x() + 4.0 * n, at.y());
      },
      20, [](int) { return Vector2d(9, 0); });
}

TEST(FilmCauses, WaterThatGlittersIsNoObject) {
  // Every patch of the water moves differently in each frame, in front of a still shore.
  constexpr int kPatch_px = 40;
  for (int water = 0; water < 5; ++water) {
    SCOPED_TRACE(water);
    expect_rest(
        [&](int n, const Vector2d& at) {
          if (at.y() < 180) return background().at(at.x(), at.y());
          const int patch =
              static_cast<int>(at.x()) / kPatch_px + 100 * (static_cast<int>(at.y()) / kPatch_px);
          std::minstd_rand random(
              static_cast<uint32_t>(1 + 977 * patch + 31337 * (n + 20 * water)));
          random.discard(3);
          const double x = static_cast<double>(random() % 9) - 4;
          const double y = static_cast<double>(random() % 9) - 4;
          return foreground().at(at.x() + x, at.y() + y);
        },
        20, 0);
  }
}

TEST(FilmCauses, AfterAFadeFromBlackTheObjectIsFeltAndNotTheBackground) {
  expect_right(
      [](int n, const Vector2d& at) {
        const double light = std::min(1.0, n / 8.0);
        const bool inside = in_disc(at, {200.0 + 6 * n, 180}, 60);
        return light * (inside ? foreground().at(at.x() - 6.0 * n, at.y())
                               : background().at(at.x() + 3.0 * n, at.y()));
      },
      20, [](int) { return Vector2d(9, 0); }, 8 + kFelt);
}

TEST(FilmCauses, InFieldsOfTwoTimesTheMotionIsNotReversed) {
  // Interlaced: even rows are from half a frame earlier than odd ones.
  const std::vector<Frame> found = analyze(
      [](int n, const Vector2d& at) {
        const double t = static_cast<int>(at.y()) % 2 == 0 ? n : n + 0.5;
        if (in_disc(at, {160.0 + 8 * t, 180}, 60)) {
          return foreground().at(at.x() - 8.0 * t, at.y());
        }
        return background().at(at.x(), at.y());
      },
      20);
  for (int n = kFelt; n < 20; ++n) {
    expect_right(found[static_cast<size_t>(n)], Vector2d(8, 0), n);
  }
}

TEST(FilmCauses, ANewShotIsFeltWithinThreeFrames) {
  // Shots of eight frames, each with a disc that moves in a different direction.
  const std::vector<Texture> walls{Texture(11, 10), Texture(12, 10), Texture(13, 10)};
  const std::vector<Vector2d> ways{{6, 0}, {0, 5}, {-6, 2}};
  const std::vector<Frame> found = analyze(
      [&](int n, const Vector2d& at) {
        const auto shot = static_cast<size_t>(n / 8);
        const int t = n % 8;
        const Vector2d middle = Vector2d(320, 180) + (t - 4) * ways[shot];
        if (in_disc(at, middle, 60)) {
          const Vector2d on = at - middle;
          return foreground().at(on.x(), on.y());
        }
        return walls[shot].at(at.x(), at.y());
      },
      24);
  for (int n = 0; n < 24; ++n) {
    const Frame& frame = found[static_cast<size_t>(n)];
    if (n % 8 == 0) {
      EXPECT_EQ(moved_px(frame), Vector2d(0, 0)) << "a cut, frame " << n;
    }
    if (n % 8 >= 3) expect_right(frame, ways[static_cast<size_t>(n / 8)], n);
  }
}

}  // namespace
}  // namespace spidar::test::film_causes_test
