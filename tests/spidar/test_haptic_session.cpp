// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Loop, thread and trace together. Waits for events, never for a fixed time.
#include "spidar/loop/loop_thread.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "tests/support/fake_device.h"
#include "tests/support/test.h"

namespace spidar::test::haptic_session_test {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kMs = 1'000'000;

/// Returns false when nothing of the kind happens within a sufficient time.
bool wait_for(const std::function<bool()>& happened) {
  for (int i = 0; i < 60'000; ++i) {
    if (happened()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

fs::path trace_path(const char* name) {
  return fs::temp_directory_path() / (std::string(name) + std::to_string(getpid()) + ".csv");
}

/// Numbers of the ticks in a trace.
std::vector<uint64_t> traced_ticks(const fs::path& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  std::vector<uint64_t> ticks;
  while (std::getline(in, line)) ticks.push_back(std::stoull(line));
  return ticks;
}

std::set<std::string> thread_names() {
  std::set<std::string> names;
  for (const auto& task : fs::directory_iterator("/proc/self/task")) {
    std::string name;
    std::getline(std::ifstream(task.path() / "comm") >> std::ws, name);
    names.insert(name);
  }
  return names;
}

TEST(NextDeadline, StaysOnItsGridAndNeverBursts) {
  EXPECT_EQ(next_deadline_ns(10 * kMs, 10 * kMs), 11 * kMs);
  EXPECT_EQ(next_deadline_ns(10 * kMs, 11 * kMs - 1), 11 * kMs);
  EXPECT_EQ(next_deadline_ns(10 * kMs, 11 * kMs), 12 * kMs);
  EXPECT_EQ(next_deadline_ns(10 * kMs, 17 * kMs + 1), 18 * kMs);
}

TEST(HapticSession, ByHand) {
  const auto log = std::make_shared<FakeDeviceLog>();
  const fs::path path = trace_path("spidar-by-hand-");
  SessionSettings settings;
  settings.threaded = false;
  uint64_t ticks = 0;
  {
    HapticSession session(load_profile(kDefaultProfile), std::make_unique<FakeDevice>(log),
                          settings);
    session.begin_trace(path);
    EXPECT_FALSE(session.scheduling().real_time);
    EXPECT_EQ(session.timing().lateness.count(), 0u);
    EXPECT_EQ(session.grip().name(), "fake");
    for (int64_t now = kMs; now <= 300 * kMs; now += kTick_ns) session.loop().tick(now, now);
    EXPECT_EQ(session.loop().snapshot().last.device, DeviceState::kRunning);
    session.drain_trace();
    EXPECT_EQ(traced_ticks(path).size(), 300u);
    ticks = log->volts.size();
  }
  EXPECT_FALSE(log->is_open);
  EXPECT_EQ(log->last_volts.volt, MotorVolts{}.volt);
  EXPECT_GT(log->volts.size(), ticks);  // a ramp, not a step
  EXPECT_EQ(traced_ticks(path).size(), log->volts.size());
  fs::remove(path);
}

TEST(HapticSession, ATraceThatBeginsLateHasAllRowsFromThenOn) {
  const fs::path path = trace_path("spidar-late-");
  SessionSettings settings;
  settings.threaded = false;
  HapticSession session(load_profile(kDefaultProfile),
                        std::make_unique<FakeDevice>(std::make_shared<FakeDeviceLog>()), settings);
  auto tick_until = [&session, now = kMs](int64_t end) mutable {
    for (; now <= end; now += kTick_ns) session.loop().tick(now, now);
  };
  tick_until(5000 * kMs);
  session.begin_trace(path);
  tick_until(5002 * kMs);
  session.drain_trace();
  EXPECT_EQ(traced_ticks(path), (std::vector<uint64_t>{5001, 5002}));
  EXPECT_EQ(session.trace_status().dropped, 0u);
  fs::remove(path);
}

TEST(HapticSession, WithItsThread) {
  const auto log = std::make_shared<FakeDeviceLog>();
  const fs::path path = trace_path("spidar-threaded-");
  {
    HapticSession session(load_profile(kDefaultProfile), std::make_unique<FakeDevice>(log));
    session.begin_trace(path);
    EXPECT_FALSE(session.scheduling().detail.empty());
    const std::set<std::string> names = thread_names();
    EXPECT_EQ(names.count("spidar-haptic"), 1u);
    HapticLoop& loop = session.loop();
    const auto last = [&] { return loop.snapshot().last; };
    ASSERT_TRUE(wait_for([&] { return last().device == DeviceState::kRunning; }));
    EXPECT_EQ(last().commanded.stacked().norm(), 0);

    loop.schedule({0, INT64_MAX / 2, {{1, 0, 0}, {0, 0, 0}}});
    loop.set_playback_clock({HapticSession::monotonic_now_ns(), 0, 1.0, true});
    const auto pushes = [&] {
      return last().device == DeviceState::kRunning && last().commanded.force_N.x() == 1;
    };
    ASSERT_TRUE(wait_for(pushes));

    log->present = false;
    log->answer = LinkFault::kGone;
    ASSERT_TRUE(wait_for([&] { return last().device == DeviceState::kLost; }));
    log->answer = LinkFault::kNone;
    log->present = true;
    ASSERT_TRUE(wait_for(pushes));
    EXPECT_EQ(loop.snapshot().counters.times_lost, 1u);
    EXPECT_GT(session.timing().cycle.count(), 0u);
  }
  EXPECT_FALSE(log->is_open);
  EXPECT_EQ(log->last_volts.volt, MotorVolts{}.volt);
  const std::vector<uint64_t> ticks = traced_ticks(path);
  ASSERT_FALSE(ticks.empty());
  for (size_t i = 1; i < ticks.size(); ++i) ASSERT_GT(ticks[i], ticks[i - 1]);
  fs::remove(path);
}

TEST(HapticSession, EndsWithDeviceLost) {
  const auto log = std::make_shared<FakeDeviceLog>();
  {
    HapticSession session(load_profile(kDefaultProfile), std::make_unique<FakeDevice>(log));
    log->present = false;
    log->answer = LinkFault::kGone;
    ASSERT_TRUE(
        wait_for([&] { return session.loop().snapshot().last.device == DeviceState::kLost; }));
  }
  EXPECT_FALSE(log->is_open);
}

TEST(HapticSession, ATraceThatCannotBeWrittenDoesNotStopTheLoop) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const Profile profile = load_profile(kDefaultProfile);
  HapticSession session(profile, make_device("sim", profile));
  EXPECT_THROW(session.begin_trace("/nonexistent/haptic.csv"), std::runtime_error);
  session.begin_trace("/dev/full");
  ASSERT_TRUE(wait_for([&] { return session.trace_status().error == ENOSPC; }));
  const uint64_t ticks = session.loop().snapshot().counters.ticks;
  EXPECT_TRUE(wait_for([&] { return session.loop().snapshot().counters.ticks > ticks; }));
}

// Another session in the same process is for the same hand.
TEST(HapticSession, WhatVibratedCountsInTheNextOneToo) {
  const Profile profile = load_profile(kDefaultProfile);
  const auto left = [](const HapticSession& session) {
    return session.loop().snapshot().vibration.left;
  };
  double left_before = 1;
  {
    HapticSession session(profile, make_device("sim", profile));
    // ±3 N take a hundredth of the store in 1.3 s.
    for (int i = 0; i < 100; ++i)
      session.loop().schedule(
          {40 * i * kMs, 40 * kMs, {{i % 2 == 0 ? 3.0 : -3.0, 0, 0}, {0, 0, 0}}});
    session.loop().set_playback_clock({HapticSession::monotonic_now_ns(), 0, 1.0, true});
    ASSERT_TRUE(wait_for([&] { return left(session) < 0.99; }));
    left_before = left(session);
  }
  HapticSession session(profile, std::make_unique<FakeDevice>(std::make_shared<FakeDeviceLog>()));
  ASSERT_TRUE(wait_for([&] { return session.loop().snapshot().last.tick > 0; }));
  // It is refilled within a day: this one would have to begin 14 minutes later.
  EXPECT_LT(left(session), 1);
  EXPECT_LT(left_before, 0.99);
}

}  // namespace
}  // namespace spidar::test::haptic_session_test
