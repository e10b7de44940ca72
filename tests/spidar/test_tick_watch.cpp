// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Checks that TickWatch, which monitors the other tests, detects every violation.
#include <gtest/gtest-spi.h>

#include "spidar/loop/tick_trace.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"
#include "tests/support/tick_watch.h"

namespace spidar::test::tick_watch_test {
namespace {

/// Counted from the tick with which a frame came: 100 until it is too old, 51 to rest, and 41 in
/// which the force may be that of the next frame.
constexpr int kFrameIsFelt_ticks = 100 + 51 + 41;

/// A loop that plays, a tick at a time.
struct Played {
  TickWatch watch;
  TickRecord record;
  bool clock_goes_on = true;

  Played() {
    show_frame();
    record.playing = true;
    record.found = Found::kHeld;
    record.device = DeviceState::kRunning;
  }

  /// The newest frame is on the screen since this tick.
  void show_frame() { record.frame_ns = record.running_ns + kTick_ns; }

  void tick(double force_N, int64_t step_ns = kTick_ns) {
    ++record.tick;
    record.monotonic_ns += step_ns;
    if (clock_goes_on) record.running_ns += step_ns;
    record.commanded.force_N.x() = force_N;
    watch.check(record, SafetyLimits{});
  }
};

TEST(TickWatch, AcceptsWhatIsAllowed) {
  Played played;
  for (int i = 0; i <= 10; ++i) played.tick(0.3 * i);
  played.tick(2.4, 5 * kTick_ns);
  played.record.playing = false;
  for (int i = 8; i >= 0; --i) played.tick(0.3 * i);
  for (int i = 0; i < 100; ++i) played.tick(0);
  played.record.tick = 0;  // opened again
  played.tick(0);
}

TEST(TickWatch, SeesAForceAboveTheLimit) {
  Played played;
  for (int i = 0; i <= 10; ++i) played.tick(0.3 * i);
  EXPECT_NONFATAL_FAILURE(played.tick(3.0 + 1e-12), "force too large");
}

TEST(TickWatch, ReportsAStepOnce) {
  Played played;
  played.tick(0);
  EXPECT_NONFATAL_FAILURE(played.tick(0.3 + 1e-9), "force changes too fast");
  played.tick(2);
}

TEST(TickWatch, SeesAForceThatIsNotANumber) {
  Played played;
  EXPECT_NONFATAL_FAILURE(played.tick(std::numeric_limits<double>::quiet_NaN()), "not finite");
}

TEST(TickWatch, SeesAForceThatStays) {
  for (const bool playing : {false, true}) {
    Played played;
    played.tick(0.1);
    played.record.playing = playing;
    played.record.found = Found::kExpired;
    for (int i = 0; i < 50; ++i) played.tick(0.1);
    EXPECT_NONFATAL_FAILURE(played.tick(0.1), "not at rest");
  }
}

TEST(TickWatch, SeesAForceOnAFrameThatIsOld) {
  for (const bool clock_goes_on : {true, false}) {
    SCOPED_TRACE(clock_goes_on);
    Played played;
    played.clock_goes_on = clock_goes_on;
    for (int i = 0; i <= kFrameIsFelt_ticks; ++i) played.tick(0.1);
    EXPECT_NONFATAL_FAILURE(played.tick(0.1), "force on an old frame");
  }
}

TEST(TickWatch, SeesAForceOnAFrameThatWasReachedLate) {
  Played played;
  played.record.frame_ns -= 2'000'000'000;
  for (int i = 0; i < kFrameIsFelt_ticks - 100; ++i) played.tick(0.1);
  EXPECT_NONFATAL_FAILURE(played.tick(0.1), "force on an old frame");
}

TEST(TickWatch, SeesAnOldFrameThatComesAndGoes) {
  // As of a loop that goes on by itself and is set back again by a clock that stands still.
  Played played;
  played.clock_goes_on = false;
  const int64_t frame_ns = played.record.frame_ns;
  for (int i = 0; i <= kFrameIsFelt_ticks; ++i) {
    played.record.frame_ns = frame_ns - (i / 10 % 2) * kTick_ns;
    played.tick(0.1);
  }
  EXPECT_NONFATAL_FAILURE(played.tick(0.1), "force on an old frame");
}

TEST(TickWatch, LetsTheForceFadeInBeforeTheNextFrame) {
  Played played;
  for (int i = 0; i <= 100; ++i) played.tick(0.1);
  for (int i = 0; i < 1000; ++i) played.tick(0);
  for (int i = 0; i < 40; ++i) played.tick(0.1);
  played.show_frame();
  for (int i = 0; i < 100; ++i) played.tick(0.1);
}

/// Rows of a trace, a millisecond apart.
class Rows {
 public:
  explicit Rows(const TemporaryFolder& folder, double speed_m_s = 0)
      : path_(folder.path / "trace.csv"), file_(path_), speed_m_s_(speed_m_s) {
    record_.device = DeviceState::kRunning;
    file_ << trace_header() << '\n';
  }

  void add(double force_N, bool acknowledged, bool brakes) {
    ++record_.tick;
    record_.monotonic_ns += kTick_ns;
    record_.pose.position_m.x() += 1e-3 * speed_m_s_;
    record_.commanded.force_N.x() = force_N;
    record_.acknowledged = acknowledged;
    record_.brakes = brakes;
    record_.max_force_N = SafetyLimits{}.max_force_N;
    record_.max_torque_Nm = SafetyLimits{}.max_torque_Nm;
    std::string row;
    append_row(record_, row);
    file_ << row;
  }

  void want(double force_N) {
    record_.wanted.force_N.x() = force_N;
    record_.playing = true;
    record_.found = Found::kHeld;
  }

  void check() {
    file_.flush();
    TickWatch().check_trace(path_);
  }

 private:
  const std::string path_;
  std::ofstream file_;
  const double speed_m_s_;
  TickRecord record_;
};

// A device that does not answer keeps what it was told last, and is lost after kMaxErrors.
TEST(TickWatch, TellsInATraceWhatTheDeviceDidNotAnswer) {
  for (const bool acknowledged : {false, true}) {
    const TemporaryFolder folder;
    Rows rows(folder);
    for (int i = 0; i < 40; ++i) rows.add(0.1, true, false);
    for (int i = 1; i < HapticLoop::kMaxErrors; ++i) rows.add(0.1, acknowledged, false);
    if (acknowledged)
      EXPECT_NONFATAL_FAILURE(rows.check(), "not at rest");
    else
      rows.check();
  }
}

// A grip that moves along x: the brake may turn the force against it at once, never along, and not
// when it is slow.
TEST(TickWatch, TellsInATraceWhenTheBrakeActs) {
  struct Case {
    double speed_m_s;
    bool brakes;
    double from_N, to_N;
    const char* fault;
  };
  for (const Case& c : {Case{1, true, 0.2, -2, nullptr}, Case{1, false, 0.2, -2, "too fast"},
                        Case{1, true, -2, 2, "the brake pushes the grip"},
                        Case{0.01, true, 0.2, -2, "a grip that is slow"}}) {
    const TemporaryFolder folder;
    Rows rows(folder, c.speed_m_s);
    rows.want(0.2);
    for (int i = 0; i < 10; ++i) rows.add(c.from_N, true, c.brakes);
    rows.add(c.to_N, true, c.brakes);
    if (c.fault == nullptr)
      rows.check();
    else
      EXPECT_NONFATAL_FAILURE(rows.check(), c.fault);
  }
}

TEST(TickWatch, MissesTheTrace) {
  TickWatch watch;
  EXPECT_NONFATAL_FAILURE(watch.check_trace("/nowhere/trace.csv"), "no haptic trace");
}

}  // namespace
}  // namespace spidar::test::tick_watch_test
