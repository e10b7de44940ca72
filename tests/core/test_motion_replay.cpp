// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A film is felt by its analysis as it would be while it is measured.
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "core/analysis/frame_renderer.h"
#include "core/analysis/motion_replay.h"
#include "tests/core/motion_rows.h"

namespace spidar::test::motion_replay_test {
namespace {

constexpr size_t kFrames = 400;

std::shared_ptr<const MotionFile> file_of(const MeasuredFilm& film) {
  return std::make_shared<MotionFile>(read_motion(film.file()));
}

AnalyzerSettings with(MotionKind motion, ControllerKind controller = ControllerKind::kNonlinear) {
  AnalyzerSettings settings;
  settings.motion = motion;
  settings.controller.kind = controller;
  settings.pointer = {0.2, 0.7};
  return settings;
}

/// Nothing but motion to the right that is as fast in every frame.
MeasuredFilm steady_film() {
  MeasuredFilm film = random_film(1, kFrames);
  for (size_t i = 0; i < kFrames; ++i) {
    film.moments[i].kind = MomentKind::kFrame;
    film.moments[i].empty = false;
    film.moments[i].turn = {};
    MeasuredFrame& frame = film.frames[i];
    frame = {};
    frame.anew = i == 0;
    frame.width = 640;
    frame.height = 360;
    if (i == 0) continue;
    frame.shown = Shown::kOther;
    frame.interval_ns = frame.shown_for_ns = kMeasuredFrame_ns;
    frame.background.emplace();
    MovingObject object;
    object.id = frame.dominant = 1;
    object.tracks = 10;
    object.area_px2 = 100;
    object.relative_px_s = {100, 0};
    frame.objects = {object};
    round_measured(frame);
  }
  return film;
}

TEST(MotionReplay, IsTheLiveForceToTheLastBit) {
  const MeasuredFilm film = random_film(5, kFrames);
  const auto file = file_of(film);
  AnalyzerSettings ruled = with(MotionKind::kObject);
  ruled.feel = std::make_shared<FeelRules>(
      "0.5-3 largest; 3-5 object at 0.5,0.5 gain 2; 5-7 region 0,0 to 0.5,1; 7-9 camera; "
      "9-11 topmost; 11-12 nothing; 12- object at 0.3,0.3");
  for (const AnalyzerSettings& settings :
       {with(MotionKind::kObject), ruled, with(MotionKind::kObjects, ControllerKind::kAdaptive),
        with(MotionKind::kCamera, ControllerKind::kLinear)}) {
    MotionReplay replay;
    replay.set_file(file, 0);
    replay.configure(settings);
    FrameRenderer live;
    MeasuredFrame frame;
    double largest_N = 0;
    for (size_t i = 0; i < kFrames; ++i) {
      const std::optional<FrameAnalysis> felt = replay.at(film.moments[i].stream_ns, 1);
      if (film.moments[i].kind != MomentKind::kFrame) {
        EXPECT_FALSE(felt) << i;
        continue;
      }
      AnalyzerSettings coded = settings;
      coded.pointer = film.moments[i].turn.place_coded(settings.pointer);
      live.configure(coded);
      frame = film.frames[i];
      const FrameAnalysis wanted =
          live.render(frame, {film.moments[i].stream_ns, film.moments[i].turn});
      ASSERT_TRUE(felt) << i;
      EXPECT_EQ(felt->wrench.stacked(), wanted.wrench.stacked()) << i;
      EXPECT_EQ(felt->repeated, wanted.repeated) << i;
      EXPECT_EQ(felt->interval_ns, wanted.interval_ns) << i;
      largest_N = std::max(largest_N, wanted.wrench.force_N.norm());
    }
    EXPECT_GT(largest_N, 0.1);
  }
}

TEST(MotionReplay, FramesThatTheSinkLeftOutCount) {
  const MeasuredFilm film = random_film(6, kFrames);
  const auto file = file_of(film);
  MotionReplay all, some;
  for (MotionReplay* replay : {&all, &some}) {
    replay->set_file(file, 0);
    replay->configure(with(MotionKind::kObject, ControllerKind::kAdaptive));
  }
  for (size_t i = 0; i < kFrames; ++i) {
    const std::optional<FrameAnalysis> felt = all.at(film.moments[i].stream_ns, 1);
    if (i % 3 != 0) continue;
    const std::optional<FrameAnalysis> also = some.at(film.moments[i].stream_ns, 1);
    ASSERT_EQ(felt.has_value(), also.has_value());
    if (felt) {
      EXPECT_EQ(felt->wrench.stacked(), also->wrench.stacked()) << i;
    }
  }
}

TEST(MotionReplay, AFrameThatIsShownAgainGoesOn) {
  const MeasuredFilm film = steady_film();
  MotionReplay replay;
  replay.set_file(file_of(film), 0);
  for (size_t i = 0; i < 10; ++i) replay.at(film.moments[i].stream_ns, 1);
  const auto felt = replay.at(film.moments[10].stream_ns, 1);
  const auto again = replay.at(film.moments[10].stream_ns, 1);
  EXPECT_TRUE(again->repeated);
  EXPECT_EQ(felt->wrench.stacked(), again->wrench.stacked());
}

TEST(MotionReplay, FindsFramesByTheirTimeOnly) {
  const MeasuredFilm film = steady_film();
  MotionReplay replay;
  constexpr int64_t kLater_ns = 3'000'000'000;
  replay.set_file(file_of(film), kLater_ns);
  constexpr int64_t kMs = 1'000'000;
  EXPECT_TRUE(replay.at(kLater_ns + film.moments[100].stream_ns, 1)) << "a seek";
  EXPECT_TRUE(replay.at(kLater_ns + film.moments[101].stream_ns + kMs, 1)) << "rounded";
  EXPECT_FALSE(replay.at(kLater_ns + film.moments[102].stream_ns + kMeasuredFrame_ns / 2, 1));
  EXPECT_FALSE(replay.at(film.moments[kFrames - 1].stream_ns + kLater_ns + 1000 * kMs, 1));
  EXPECT_FALSE(replay.at(0, 1)) << "before the first";
}

TEST(MotionReplay, IsFasterAtAHigherRateAndTheOtherWayBackwards) {
  const MeasuredFilm film = steady_film();
  const auto file = file_of(film);
  const double measured_px_s = film.frames[10].objects[0].relative_px_s.x();
  for (const double rate : {0.5, 2.0, -1.0, -2.0}) {
    MotionReplay replay;
    replay.set_file(file, 0);
    for (int n = 0; n < 20; ++n) {
      const size_t i = rate > 0 ? 10 + n : 300 - n;
      const auto felt = replay.at(film.moments[i].stream_ns, rate);
      ASSERT_TRUE(felt);
      EXPECT_EQ(felt->motion.velocity_px_s.x(), rate * measured_px_s);
      EXPECT_EQ(felt->wrench.force_N.x() > 0, rate > 0);
    }
  }
}

AnalyzerSettings with_rules(const std::string& rules) {
  AnalyzerSettings settings = with(MotionKind::kObject);
  settings.feel = std::make_shared<FeelRules>(rules);
  return settings;
}

TEST(MotionReplay, KnowsTheObjectOfARuleWhereverPlaybackBegins) {
  const MeasuredFilm film = steady_film();
  const auto time_of = [&](size_t i) { return film.moments[i].stream_ns; };
  MotionReplay replay;
  replay.set_file(file_of(film), 0);
  replay.configure(with_rules("0-6 object at 0.5,0.5; 6-12 object at 0.1,0.1; 12- camera"));
  EXPECT_EQ(replay.at(time_of(100), 1)->felt_object, 1u) << "after a seek";
  EXPECT_EQ(replay.at(time_of(200), 1)->felt_object, 0u);
  EXPECT_EQ(replay.at(time_of(200), 1)->choice.state, ChoiceState::kNotThere);
  // Backwards from one rule to another.
  replay.at(time_of(160), -1);
  for (size_t i = 159; i > 140; --i) {
    EXPECT_EQ(replay.at(time_of(i), -1)->felt_object, i >= 150 ? 0u : 1u) << i;
  }
  replay.configure(with_rules("0- object at 0.5,0.5"));
  EXPECT_EQ(replay.at(time_of(142), 1)->felt_object, 1u) << "rules that were set while it plays";
}

}  // namespace
}  // namespace spidar::test::motion_replay_test
