// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A device that renders late gets wrenches early, as far as the film is known ahead.
#include "spidar/loop/loop_schedule.h"
#include "tests/support/test.h"

namespace spidar::test::look_ahead_test {
namespace {

constexpr int64_t kMs = 1'000'000, kSecond = 1000 * kMs;

/// A film whose force rises by 1 N a second, each frame of which is known `known_ms` before it is
/// on the screen.
struct Film {
  int64_t lag_ms, known_ms, interval_ms = 33;

  /// What the device renders at the end of `ms`.
  struct Shown {
    int64_t late_ns = 0;
    int silent_ms = 0;     ///< after the first quarter of a second
    double latest_ns = 0;  ///< that a wrench is rendered after its time in the film, since then
    double steepest_N_s = 0;
  };
  Shown play(int ms) {
    Shown shown;
    double before_N = 0;
    for (int64_t now_ns = 0; now_ns < ms * kMs; now_ns += kMs) {
      for (; pushed_ns <= now_ns + known_ms * kMs; pushed_ns += interval_ms * kMs) {
        TimedWrench frame;
        frame.time_ns = pushed_ns;
        frame.hold_ns = WrenchTimeline::hold_after(interval_ms * kMs);
        frame.wrench.force_N.x() = 1e-9 * static_cast<double>(pushed_ns);
        EXPECT_TRUE(schedule->push(frame));
      }
      const TimelineResult found = schedule->find(true, now_ns, lag_ms * kMs);
      shown.late_ns = schedule->late_ns();
      if (now_ns < kSecond / 4) continue;
      const double force_N = found.wrench.force_N.x();
      const double rendered_ns = 1e9 * force_N,
                   heard_ns = static_cast<double>(now_ns + lag_ms * kMs);
      shown.latest_ns = std::max(shown.latest_ns, heard_ns - rendered_ns);
      if (found.found == Found::kExpired || found.found == Found::kNothing) ++shown.silent_ms;
      if (now_ns > kSecond / 4)
        shown.steepest_N_s = std::max(shown.steepest_N_s, 1e3 * (force_N - before_N));
      EXPECT_GE(force_N, before_N) << "time went back at " << now_ns / kMs << " ms";
      before_N = force_N;
    }
    return shown;
  }

  int64_t pushed_ns = 0;
  std::unique_ptr<LoopSchedule> schedule = std::make_unique<LoopSchedule>();
};

TEST(LookAhead, AFilmThatIsKnownFarAheadIsRenderedInTime) {
  for (const int64_t lag_ms : {0, 30, 70, 100, 250}) {
    const Film::Shown shown = Film{lag_ms, 400}.play(3000);
    EXPECT_EQ(shown.late_ns, 0) << lag_ms;
    EXPECT_EQ(shown.silent_ms, 0) << lag_ms;
    EXPECT_NEAR(shown.latest_ns, 0, 1e3) << lag_ms;
  }
}

/// There is a force, however much the device lags, and it is said how late it is.
TEST(LookAhead, AFilmThatIsKnownTooLateIsRenderedLate) {
  for (const int64_t interval_ms : {16, 33, 100}) {
    for (const int64_t lag_ms : {30, 45, 60, 100, 250}) {
      for (const int64_t known_ms : {interval_ms, interval_ms + 5, interval_ms + 30}) {
        const std::string where = std::to_string(lag_ms) + " ms of lag, frames of " +
                                  std::to_string(interval_ms) + " ms known " +
                                  std::to_string(known_ms) + " ms ahead";
        // Just before the next frame is known, the newest is so far ahead.
        const int64_t ahead_ms = known_ms - interval_ms,
                      late_ms = std::max<int64_t>(0, lag_ms - ahead_ms);
        const Film::Shown shown = Film{lag_ms, known_ms, interval_ms}.play(3000);
        EXPECT_EQ(shown.silent_ms, 0) << where;
        const auto late = static_cast<double>(late_ms), interval = static_cast<double>(interval_ms);
        EXPECT_NEAR(1e-6 * static_cast<double>(shown.late_ns), late, 0.1 * interval + 1) << where;
        // A curve whose next frame is not known yet ends level: up to 4/27 of a step behind.
        EXPECT_LE(1e-6 * shown.latest_ns, late + 4. / 27 * interval + 2) << where;
        // A curve is at most 1.5 times as steep as the line, and the delay is made up for at 10 %.
        EXPECT_LE(shown.steepest_N_s, 1.5 * 1.1 + 1e-9) << where;
      }
    }
  }
}

TEST(LookAhead, ADelayIsMadeUpFor) {
  Film film{70, 35};
  EXPECT_GT(film.play(1000).late_ns, 60 * kMs);
  // From now on, frames are known earlier.
  film.known_ms = 300;
  film.schedule->cancel();
  film.pushed_ns = 0;
  EXPECT_EQ(film.play(2000).late_ns, 0);
}

TEST(LookAhead, AFilmThatStopsExpires) {
  Film film{100, 150};
  film.play(1000);
  const int64_t last_ns = film.pushed_ns - 33 * kMs;
  int64_t now_ns = kSecond;
  while (film.schedule->find(true, now_ns, 100 * kMs).found != Found::kExpired) now_ns += kMs;
  EXPECT_NEAR(static_cast<double>(now_ns), static_cast<double>(last_ns + 43 * kMs), kMs);
}

TEST(LookAhead, ATrackIsRenderedAsFarAsItIsKnown) {
  for (const int64_t known_ms : {60, 400}) {
    constexpr int64_t kLag_ms = 100;
    const auto schedule = std::make_unique<LoopSchedule>();
    int64_t pushed_ns = 0;
    for (int64_t now_ns = 0; now_ns < 2 * kSecond; now_ns += kMs) {
      for (; pushed_ns <= now_ns + known_ms * kMs; pushed_ns += 20 * kMs) {
        TrackBlock block;
        block.begin_ns = pushed_ns;
        block.duration_ns = 20 * kMs;
        block.count = 20;
        for (size_t i = 0; i < block.count; ++i)
          block.samples[i][0] = static_cast<float>(1e-10 * static_cast<double>(block.time_ns(i)));
        EXPECT_TRUE(schedule->push(block));
      }
      const TimelineResult found = schedule->find(true, now_ns, kLag_ms * kMs);
      if (now_ns < kSecond) continue;
      EXPECT_TRUE(found.found == Found::kInterpolated || found.found == Found::kExact ||
                  found.found == Found::kHeld)
          << now_ns;
      const double late_ms =
          1e-6 * static_cast<double>(now_ns) + kLag_ms - 1e3 * found.wrench.force_N.x();
      // Of the film at least known_ms are known, and at most a block more.
      EXPECT_LE(late_ms, static_cast<double>(std::max<int64_t>(0, kLag_ms - known_ms)) + 2 + 1);
      EXPECT_GE(late_ms, static_cast<double>(std::max<int64_t>(0, kLag_ms - known_ms - 20)) - 1);
    }
  }
}

}  // namespace
}  // namespace spidar::test::look_ahead_test
