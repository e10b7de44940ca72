// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Which points the tracker chooses. When a picture is shown twice, each one gives a point that
// starts at the point.
#include "core/points/tracker.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"
#include "tests/support/texture.h"

namespace spidar::test::feature_selection_test {
namespace {

using test::Picture;
using test::Texture;

std::vector<FollowedPoint> selected(const Picture& picture, const TrackerSettings& settings = {}) {
  OpenCvTracker tracker(settings);
  tracker.track(picture.view());
  return tracker.track(picture.view()).points;
}

double distance(const ImagePoint& a, const ImagePoint& b) {
  return std::hypot(static_cast<double>(a.x_px) - static_cast<double>(b.x_px),
                    static_cast<double>(a.y_px) - static_cast<double>(b.y_px));
}

/// Fraction of the interval [from, to] that a pixel around `x` covers.
double cover(double x, double from, double to) {
  return std::max(0.0, std::min(x + 0.5, to) - std::max(x - 0.5, from));
}

Picture textured(int width, int height, double cell_px = 8) {
  Picture picture(width, height);
  const Texture texture(3, cell_px);
  picture.fill([&](double x, double y) { return texture.at(x, y); });
  return picture;
}

TEST(FeatureSelection, AFlatPictureHasNone) {
  for (const double grey : {0.0, 128.0, 255.0}) {
    Picture picture(640, 360);
    picture.fill([grey](double, double) { return grey; });
    OpenCvTracker tracker;
    EXPECT_EQ(tracker.track(picture.view()).features, 0);
    const OpenCvTracker::Result& again = tracker.track(picture.view());
    EXPECT_EQ(again.features, 0);
    EXPECT_TRUE(again.points.empty());
    EXPECT_NE(again.picture, FrameComparison::kFirst);
  }
}

TEST(FeatureSelection, RoundingNoiseHasNone) {
  // What a flat grey between two levels looks like after dithering: relative to its strongest
  // corner all of it is corners.
  Picture picture(640, 360);
  std::mt19937 random(23);
  picture.fill([&](double, double) { return 128.0 + static_cast<double>(random() & 1u); });
  OpenCvTracker tracker;
  EXPECT_EQ(tracker.track(picture.view()).features, 0) << "seed 23";
}

TEST(FeatureSelection, KeepsTheMinimumDistanceOfTheReferenceFrame) {
  struct Size {
    int width, height;
  };
  for (const Size size : {Size{640, 360}, Size{1280, 720}, Size{1921, 1081}}) {
    for (const double min_distance_px : {5.0, 10.0, 40.0}) {
      TrackerSettings settings;
      settings.min_distance_px = min_distance_px;
      const std::vector<FollowedPoint> found =
          selected(textured(size.width, size.height, size.height / 45.0), settings);
      ASSERT_GE(found.size(), 20u);
      double nearest = 1e9;
      for (size_t i = 0; i < found.size(); ++i) {
        for (size_t j = 0; j < i; ++j) {
          nearest = std::min(nearest, distance(found[i].from, found[j].from));
        }
      }
      // The points lie on whole pixels of the reduced picture; 1e-3 is float at 2000 px.
      EXPECT_GE(nearest, min_distance_px * size.height / kReferenceHeight_px - 1e-3)
          << size.width << "x" << size.height << ", distance " << min_distance_px;
    }
  }
}

TEST(FeatureSelection, KeepsTheMaximumNumber) {
  OpenCvTracker tracker;
  EXPECT_EQ(tracker.track(textured(640, 360).view()).features, 200);
}

TEST(FeatureSelection, AMirroredPictureHasMirroredPoints) {
  // Right only if the centre of the first pixel is 0 at every reduction: a point at x goes to
  // width − 1 − x. Widths and heights are multiples of the factor: nothing is cut off.
  struct Size {
    int width, height, factor;
  };
  for (const Size size : {Size{480, 288, 1}, Size{960, 540, 2}, Size{1920, 1080, 4}}) {
    const double unit = size.factor;
    Picture picture(size.width, size.height);
    Picture mirrored(size.width, size.height);
    // Rectangles of different sizes, far from each other, with edges on whole reduced pixels.
    const auto grey = [unit](double x, double y) {
      double sum = 40;
      for (int i = 0; i < 4; ++i) {
        const double left = (40 + 90 * i) * unit - 0.5;
        const double top = (50 + 30 * i) * unit - 0.5;
        sum += (100 + 20 * i) * cover(x, left, left + (30 + 5 * i) * unit) *
               cover(y, top, top + (25 + 7 * i) * unit);
      }
      return sum;
    };
    picture.fill(grey);
    mirrored.fill([&](double x, double y) { return grey(size.width - 1 - x, y); });
    std::set<std::pair<float, float>> points;
    for (const FollowedPoint& point : selected(picture))
      points.insert({point.from.x_px, point.from.y_px});
    std::set<std::pair<float, float>> back;
    for (const FollowedPoint& point : selected(mirrored)) {
      back.insert({static_cast<float>(size.width - 1) - point.from.x_px, point.from.y_px});
    }
    EXPECT_EQ(points.size(), 16u) << size.width;
    EXPECT_EQ(points, back) << size.width;
  }
}

}  // namespace
}  // namespace spidar::test::feature_selection_test
