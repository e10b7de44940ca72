// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A still picture around a film is no background in front of which the film moves.
#include "core/analysis/motion_analyzer.h"
#include "core/motion/layers/burned_in.h"
#include "tests/support/scene_film.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::margins_test {
namespace {

using Eigen::Vector2d;

constexpr int kFrames = 30;
/// Margins are known after some pairs of pictures in which the film moves. What seemed to be an
/// object is seen at rest then.
constexpr size_t kKnown = Margins::kKnownAfterPairs + 3;

const Texture kBackground(1, 10);
const Texture kForeground(2, 10);

bool in_box(const Vector2d& at, double left, double top, double width, double height) {
  return at.x() >= left && at.x() < left + width && at.y() >= top && at.y() < top + height;
}

/// Motion that is felt in each frame, px.
std::vector<Vector2d> feel(const Scene& scene) {
  MotionAnalyzer analyzer;
  Picture picture(kSceneWidth, kSceneHeight);
  std::vector<Vector2d> felt_px;
  for (int n = 0; n < kFrames; ++n) {
    picture.fill([&](double x, double y) { return scene(n, {x, y}); });
    const Frame found = analyzer.analyze(picture.view(), n * kSceneFrame_ns);
    felt_px.push_back(found.motion.velocity_px_s * kSceneFrame_s);
  }
  return felt_px;
}

/// With sensor noise of 1.5 grey levels in the film and a frame of an eighth of its height around
/// it, which has more than half of the votes on the camera: those at the border count twice.
Scene framed(const Scene& film) {
  return [film, random = std::mt19937(1), noise = std::normal_distribution<double>(0, 1.5)](
             int n, const Vector2d& at) mutable {
    constexpr double kWide_px = kSceneHeight / 8.0;
    if (!in_box(at, kWide_px, kWide_px, kSceneWidth - 2 * kWide_px, kSceneHeight - 2 * kWide_px)) {
      return kForeground.at(at.x(), at.y() + 700);
    }
    return std::clamp(film(n, at) + noise(random), 0.0, 255.0);
  };
}

TEST(Margins, AreTheBorderOfAFilmThatPans) {
  const auto felt_px = feel(framed([](int n, const Vector2d& at) {
    return kBackground.at(at.x() + 3.0 * n, at.y() - 1.0 * n);
  }));
  for (size_t n = kKnown; n < kFrames; ++n) EXPECT_EQ(felt_px[n], Vector2d(0, 0)) << n;
}

TEST(Margins, LeaveAnObjectInFrontOfAPanAsItIs) {
  const auto felt_px = feel(framed([](int n, const Vector2d& at) {
    if ((at - Vector2d(200.0 + 4 * n, 190)).norm() < 55) {
      return kForeground.at(at.x() - 4.0 * n, at.y());
    }
    return kBackground.at(at.x() + 4.0 * n, at.y());
  }));
  // What seemed to be an object stood out for some frames, so that it may rest for somewhat longer
  // than DominantObject::kReason_s: three frames later the disc is followed, and has points. Its
  // blocks alone give its motion to a tenth of a pixel of the field, which is 1.5 of the frame's.
  for (size_t n = kKnown + 3; n < kFrames; ++n) {
    EXPECT_LT((felt_px[n] - Vector2d(8, 0)).norm(), 0.15) << n;
  }
}

TEST(Margins, MakeAnewWhatWasAnObjectAndIsAtTheirBorder) {
  // A bush in front of a pan grows out of the lower bar. Until the sky shows something, the bars
  // are unknown, so that the bush does not touch the border of the picture and is taken for an
  // object.
  constexpr double kBar_px = kSceneHeight / 8.0;
  constexpr int kClear = 10;
  const auto felt_px = feel([](int n, const Vector2d& at) {
    if (!in_box(at, 0, kBar_px, kSceneWidth, kSceneHeight - 2 * kBar_px)) return 16.0;
    if (n < kClear && at.y() < 120) return 128.0;
    const double x = at.x() - 12.0 * n;
    return in_box({x, at.y()}, 120, 235, 200, kSceneHeight)
               ? kForeground.at(x, at.y())
               : kBackground.at(at.x() - 4.0 * n, at.y());
  });
  EXPECT_GT(felt_px[kClear - 1].x(), 1);
  for (size_t n = kClear + kKnown; n < kFrames; ++n) EXPECT_EQ(felt_px[n], Vector2d(0, 0)) << n;
}

TEST(Margins, AreNotWhatIsAroundALargeObject) {
  // A box of two thirds of width and height moves to and fro, five frames each, in front of a still
  // scene without noise.
  const auto position = [](int n) { return 4.0 * std::abs(n % 10 - 5); };
  const auto felt_px = feel([&](int n, const Vector2d& at) {
    const double x = at.x() - position(n);
    return in_box({x, at.y()}, 97, 60, 426, 240) ? kForeground.at(x, at.y())
                                                 : kBackground.at(at.x(), at.y());
  });
  // It is the same object for two frames after it has turned round.
  for (int n = static_cast<int>(kKnown); n < kFrames; ++n) {
    if ((n + 4) % 5 < 2) continue;
    EXPECT_NEAR(felt_px[static_cast<size_t>(n)].x(), position(n) - position(n - 1), 0.15) << n;
  }
}

}  // namespace
}  // namespace spidar::test::margins_test
