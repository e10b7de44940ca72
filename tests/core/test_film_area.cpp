// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What is felt while the analysis finds where the film is, and when that changes.
#include <algorithm>
#include <set>

#include "core/analysis/motion_analyzer.h"
#include "tests/core/screen_scenes.h"
#include "tests/support/picture.h"
#include "tests/support/test.h"

namespace spidar::test::screen::film_area_test {
namespace {

std::vector<Frame> frames_of(const Scene& scene, const AnalyzerSettings& settings, int pictures) {
  MotionAnalyzer analyzer(settings);
  Picture picture(kWidth, kHeight);
  std::vector<Frame> frames;
  for (int n = 0; n < pictures; ++n) {
    picture.fill([&](double x, double y) { return scene(n, x, y); });
    frames.push_back(analyzer.analyze(picture.view(), n * kPicture_ns));
  }
  return frames;
}

/// The motion that is felt, px/s.
std::vector<Eigen::Vector2d> felt(const Scene& scene, AreaSetting::Kind area, int pictures) {
  AnalyzerSettings settings;
  settings.area.kind = area;
  std::vector<Eigen::Vector2d> felt;
  for (const Frame& frame : frames_of(scene, settings, pictures)) {
    felt.push_back(frame.motion.velocity_px_s);
  }
  return felt;
}

/// From the first picture on, as in the whole picture.
TEST(FilmArea, HasNoShareInHowAnObjectIsFelt) {
  for (const double speed : {2.0, 5.0}) {
    for (const auto& [across, down] : kDirections) {
      const Scene scene = square(speed, across, down);
      const std::vector<Eigen::Vector2d> whole = felt(scene, AreaSetting::Kind::kWhole, kRate);
      EXPECT_EQ(felt(scene, AreaSetting::Kind::kAuto, kRate), whole) << speed << " " << across;
      EXPECT_FALSE(whole.back().isZero()) << speed << " " << across;
    }
  }
}

TEST(FilmArea, MakesNoFilmWaitWhoseBordersChange) {
  EXPECT_EQ(felt(disc_before_a_pan, AreaSetting::Kind::kAuto, kRate),
            felt(disc_before_a_pan, AreaSetting::Kind::kWhole, kRate));
}

/// It is measured beside what is felt until it shows as much: nothing is lost that is felt in the
/// whole picture.
TEST(FilmArea, ChangesToTheFilmWithoutAGap) {
  const Scene film = then(kRate, disc, disc_before_a_pan);
  const Scene scene = within(page, kMiddle, film);
  const std::vector<Eigen::Vector2d> whole = felt(scene, AreaSetting::Kind::kWhole, 2 * kRate);
  const std::vector<Eigen::Vector2d> moved = felt(scene, AreaSetting::Kind::kAuto, 2 * kRate);
  for (size_t n = 0; n < moved.size(); ++n) {
    EXPECT_TRUE(whole[n].isZero() || !moved[n].isZero()) << n;
  }
  EXPECT_NE(moved.back(), whole.back());
}

/// A camera that moves is not felt, except before it is known to be one.
TEST(FilmArea, KnowsSoonThatAFilmIsNoObject) {
  const std::vector<Eigen::Vector2d> moved =
      felt(within(page, kMiddle, pan), AreaSetting::Kind::kAuto, kRate);
  for (size_t n = AreaFinder::kStays; n < moved.size(); ++n) EXPECT_TRUE(moved[n].isZero()) << n;
}

/// An id of the page's objects would otherwise mean another object of the film.
TEST(FilmArea, GivesEachObjectItsOwnId) {
  const Scene film = then(kRate, disc, disc_before_a_pan);
  std::set<uint32_t> of_page, of_film;
  for (const Frame& frame : frames_of(within(page, kMiddle, film), {}, 3 * kRate)) {
    std::set<uint32_t>& ids = frame.width() == kWidth ? of_page : of_film;
    for (const MovingObject& object : frame.objects) ids.insert(object.id);
  }
  EXPECT_FALSE(of_page.empty());
  EXPECT_FALSE(of_film.empty());
  for (const uint32_t id : of_film) EXPECT_EQ(of_page.count(id), 0u) << id;
}

/// It is known at once that another film goes on, but its motion only in the next picture.
TEST(FilmArea, ChangesToAnotherFilmWithoutAGap) {
  const Part second{10, 10, 150, 85}, first{170, 60, 250, 150};
  const auto other_pan = [](int n, double x, double y) { return kOther.at(x - 2 * n, y); };
  const int rests = 2 * kRate;
  const auto stopped = [&](int, double x, double y) { return pan(rests - 1, x, y); };
  const Scene both = within(within(page, second, other_pan), first, then(rests, pan, stopped));
  for (const MotionKind motion : {MotionKind::kObject, MotionKind::kCamera, MotionKind::kMean}) {
    AnalyzerSettings settings;
    settings.motion = motion;
    const std::vector<Frame> frames = frames_of(both, settings, 7 * kRate);
    for (size_t n = kRate; n < frames.size(); ++n) {
      EXPECT_TRUE(frames[n].has_motion_before()) << static_cast<int>(motion) << " " << n;
    }
    EXPECT_GT(frames[kRate].place.area.x, second.x + second.width);
    EXPECT_LT(frames.back().place.area.x, first.x);
    EXPECT_LT(frames.back().width(), kWidth / 2);
  }
}

/// While the finder searches, whatever is measured meanwhile.
TEST(FilmArea, IsUnknownFromTheFullScreenOnUntilTheSearchEnds) {
  const int when = 2 * kRate;
  const auto search = static_cast<int>(AreaFinder::kSearch_ns / kPicture_ns);
  const Scene scene = then(when, within(page, kMiddle, pan), pan);
  for (const MotionKind motion : {MotionKind::kCamera, MotionKind::kMean}) {
    AnalyzerSettings settings;
    settings.motion = motion;
    const std::vector<Frame> frames = frames_of(scene, settings, when + search + 3);
    for (int n = when - 1; n < when + search + 3; ++n) {
      const bool searches = n >= when && n < when + search;
      const Frame& frame = frames[static_cast<size_t>(n)];
      EXPECT_EQ(frame.place.is_known, !searches) << static_cast<int>(motion) << " " << n;
      if (searches) {
        EXPECT_FALSE(frame.has_motion_before()) << static_cast<int>(motion) << " " << n;
      }
    }
  }
}

}  // namespace
}  // namespace spidar::test::screen::film_area_test
