// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Drivers of force-feedback devices that are slow, hang, or fail now and then.
#include <cerrno>
#include <linux/input.h>
#include <sched.h>

#include "spidar/devices/force_feedback/evdev_transport.h"
#include "spidar/devices/force_feedback/stick_effects.h"
#include "spidar/realtime/thread_setup.h"
#include "tests/spidar/bus_test.h"
#include "tests/spidar/force_bench.h"
#include "tests/support/felt_player.h"
#include "tests/support/pushed_grip.h"
#include "tests/support/test.h"

namespace spidar::test::force_feedback_faults_test {
namespace {

constexpr int64_t kMs = kSecond_ns / 1000;
/// 20 % of 0xFFFF.
constexpr int kGain = 13107;

/// A stick that is moved from stop to stop, 118 mm apart, in `half_ms`.
ff::Position swinging(int64_t now_ns, int half_ms) {
  const double phase = M_PI * static_cast<double>(now_ns) / static_cast<double>(half_ms * kMs);
  return {static_cast<int16_t>(std::lround(ff::Position::kFull * std::sin(phase))), 0};
}

/// Steps of the readings are 20, 15 and 13 mm.
TEST(StickPosition, MovesAtTheSpeedOfTheHand) {
  const double reach_m = 0.059 / 2;
  for (const auto& [update_ms, half_ms] : {std::pair{55, 250}, {25, 150}, {5, 35}}) {
    boards::StickPosition place;
    place.start(swinging(0, half_ms), 0);
    double largest_m = 0, read_m = 0, largest_read_m = 0;
    for (int64_t ms = 1; ms < 1000; ++ms) {
      const double before_m = reach_m * place.fraction().x();
      if (ms % update_ms == 0) {
        // The previous reading has arrived when the next one is taken.
        place.advance(ms * kMs);
        EXPECT_NEAR(reach_m * place.fraction().x(), read_m, 1e-12);
        const ff::Position position = swinging(ms * kMs, half_ms);
        place.update(position, ms * kMs);
        const double now_m = reach_m * position.right / ff::Position::kFull;
        largest_read_m = std::max(largest_read_m, std::abs(now_m - read_m));
        read_m = now_m;
      }
      place.advance(ms * kMs);
      largest_m = std::max(largest_m, std::abs(reach_m * place.fraction().x() - before_m));
    }
    EXPECT_GT(largest_read_m, 10e-3);
    // The fastest hand: pi / 35 ms x 29.5 mm = 2.6 m/s; a reading is rounded to 3 um.
    const double fastest_m = reach_m * M_PI / half_ms + reach_m / ff::Position::kFull;
    EXPECT_LE(largest_m, fastest_m);
  }
}

TEST(StickPosition, IsReachedSoonAfterALongUpdateAndWhenExchangesAreLate) {
  boards::StickPosition place;
  place.start({100, 200}, 0);
  EXPECT_EQ(place.fraction(), Eigen::Vector2d(0.01, 0.02));
  place.update({10'000, -10'000}, 3 * kSecond_ns);
  place.advance(3 * kSecond_ns);
  EXPECT_LT(place.fraction().x(), 1);
  place.advance(3 * kSecond_ns + boards::StickPosition::kLongest_ns);
  EXPECT_EQ(place.fraction(), Eigen::Vector2d(1, -1));
  place.update({0, 0}, 4 * kSecond_ns);
  place.advance(5 * kSecond_ns);
  EXPECT_EQ(place.fraction(), Eigen::Vector2d(0, 0));
}

class ForceFeedbackFaults : public BusTest {
 protected:
  static std::unique_ptr<Grip> stepped() {
    return make_grip("ff", load_profile(kDefaultProfile), unguarded());
  }
};

/// 13 mm between two updates of a fast driver.
TEST_F(ForceFeedbackFaults, AFastHandLosesNoPose) {
  ForceBench bench("ff");
  HapticSession session(bench.grip(), by_hand());
  for (int64_t now_ns = kTick_ns; now_ns < 2 * kSecond_ns; now_ns += kTick_ns) {
    if (now_ns > kSecond_ns / 2) bench.motors.count[0] = swinging(now_ns, 35).right;
    session.loop().tick(now_ns, now_ns);
  }
  EXPECT_EQ(session.loop().snapshot().counters.pose_errors, 0u);
  EXPECT_EQ(session.loop().snapshot().last.device, DeviceState::kRunning);
}

/// Its last force stays, which neither this process nor a guardian can change; but nobody is told
/// that all is well. The test makes the ticks, so that no other thread can be too late for them.
TEST_F(ForceFeedbackFaults, ADriverThatHangsIsATimeOut) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  {
    HapticSession session(stepped(), by_hand());
    const auto tick = [&loop = session.loop()] {
      const int64_t now_ns = monotonic_now_ns() + kTick_ns;
      sleep_until_ns(now_ns);
      loop.tick(now_ns, now_ns);
    };
    session.loop().set_playback_clock({monotonic_now_ns(), kSecond_ns, 1.0, true});
    ASSERT_TRUE(session.loop().schedule(lasting({2, 0, 0})));
    while (!is_level(evdev_levels(0).right, 2, 2)) {
      tick();
      if (session.loop().lost()) session.loop().reopen();
    }
    port.upload_ms = 1'000'000;
    session.loop().cancel_scheduled();
    ASSERT_TRUE(session.loop().schedule(lasting({2.2, 0, 0})));
    while (!session.loop().lost()) tick();
    EXPECT_EQ(session.grip().health().last_fault, LinkFault::kTimeout);
    port.upload_ms = 0;
  }
  EXPECT_TRUE(evdev_levels(0).at_rest());
}

/// A process that is stopped looks the same to the device.
TEST_F(ForceFeedbackFaults, AnEffectEndsWhenTheLoopOrTheDriverHangs) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  port.expires = true;
  {
    const FeltPlayer player;
    player.push(2, 0);
    wait_for([&] { return port.plays > 10; });
    wait_for([] { return is_level(evdev_levels(0).right, 2, 2); });
    port.hangs = true;
    player.loop().cancel_scheduled();
    ASSERT_TRUE(player.loop().schedule(lasting({2.5, 0, 0})));
    wait_for([] { return evdev_levels(0).at_rest(); });
    port.hangs = false;
  }
  const auto device = stepped();
  device->open();
  wait_for([&] {
    device->exchange(told(1));
    return !evdev_levels(0).at_rest();
  });
  wait_for([] { return evdev_levels(0).at_rest(); });
}

/// Only then are the effects ended; and nobody else gets the device before.
TEST_F(ForceFeedbackFaults, ADriverThatHangsDoesNotKeepTheDeviceFromBeingClosed) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  const auto device = stepped();
  {
    const FeltPlayer player;
    player.push(2, 0);
    wait_for([] { return is_level(evdev_levels(0).right, 2, 2); });
    port.hangs = true;
    player.loop().cancel_scheduled();
    ASSERT_TRUE(player.loop().schedule(lasting({2.5, 0, 0})));
    wait_for([&] { return port.hanging > 0; });
  }
  EXPECT_GT(port.hanging, 0);
  EXPECT_FALSE(evdev_levels(0).at_rest());
  EXPECT_THROW(device->open(), DeviceError);
  port.hangs = false;
  wait_for([] { return evdev_levels(0).at_rest(); });
  wait_for([&] { return opening(*device).empty(); });
}

TEST_F(ForceFeedbackFaults, OneFailedUpdateOfASlowDriverIsNoLoss) {
  for (const int upload_ms : {0, 50}) {
    EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
    const FeltPlayer player;
    player.push(1, 0);
    wait_for([] { return is_level(evdev_levels(0).right, 1, 1); });
    port.upload_ms = upload_ms;
    port.failing = 1;
    port.upload_error = EIO;
    player.loop().cancel_scheduled();
    ASSERT_TRUE(player.loop().schedule(lasting({1.5, 0, 0})));
    wait_for([] { return is_level(evdev_levels(0).right, 1.5, 1.5); });
    EXPECT_EQ(port.failing, 0);
    // The loop loses a device after 20 in a row.
    EXPECT_EQ(player.session->grip().health().count(LinkFault::kBusError), 1u);
  }
}

TEST_F(ForceFeedbackFaults, CallsThatASignalInterruptsAreRepeated) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick, "hid-generic");
  port.signals = true;
  {
    const FeltPlayer player;
    EXPECT_EQ(player.session->grip().description(),
              "Emulated Stick at 20 % of its strength, force feedback on two axes");
    player.push(1, -1);
    wait_for([] {
      const EvdevLevels levels = evdev_levels(0);
      return is_level(levels.right, 1, 1) && is_level(levels.up, -1, 1);
    });
    EXPECT_EQ(port.gain, kGain);
    EXPECT_EQ(port.autocentre, 0);
    port.axis[0] = 500;
    wait_for([&] { return player.now().last.pose.position_m.x() > 0.014; });
    EXPECT_EQ(player.session->grip().health().errors(), 0u);
  }
  EXPECT_EQ(port.autocentre, 0xFFFF);
}

/// Another gain would scale the force, and a centring spring would add to it.
TEST_F(ForceFeedbackFaults, NoLevelIsSetUntilGainAndAutocentreAre) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  port.setting_error = EIO;
  const FeltPlayer player;
  ASSERT_TRUE(player.loop().schedule(lasting({1, 0, 0})));
  wait_for([&] { return player.session->grip().health().count(LinkFault::kBusError) > 20; });
  EXPECT_TRUE(evdev_levels(0).at_rest());
  port.setting_error = 0;
  wait_for([] { return is_level(evdev_levels(0).right, 1, 1); });
  EXPECT_EQ(port.gain, kGain);
}

TEST_F(ForceFeedbackFaults, AnOpeningThatFailsChangesNoSetting) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick, "hid-generic");
  port.upload_error = ENOSPC;
  EXPECT_THROW(FeltPlayer(), DeviceError);
  EXPECT_EQ(port.settings, 0u);
  EXPECT_EQ(port.autocentre, 0xFFFF);
}

/// A host and its guardian may be a 32-bit and a 64-bit program, which have different input events.
TEST_F(ForceFeedbackFaults, ItsWillIsTheSameForPrograms32And64BitsWide) {
  plug_evdev(0, EvdevKind::kStick, "hid-generic");
  boards::ForceFeedback board("ff", load_profile(kDefaultProfile),
                              std::make_unique<EvdevTransport>("ff", ""),
                              boards::StickEffects::Updates::kInCycle);
  board.open();
  const std::vector<LastWill> wills = board.last_wills();
  ASSERT_EQ(wills.size(), 1u);
  const LastWill& will = wills[0];
  EXPECT_EQ(will.wire, LastWill::Wire::kInput);
  ASSERT_EQ(will.packets, 2u);
  struct Case {
    uint32_t code;
    int32_t value;
  };
  const Case expected[] = {{0, 0}, {1, 0}};
  for (size_t i = 0; i < 2; ++i) {
    LastWill::InputEvent event;
    ASSERT_EQ(will.length[i], 8u);
    std::memcpy(&event, will.packet[i].data(), sizeof event);
    EXPECT_EQ(event.code, expected[i].code);
    EXPECT_EQ(event.value, expected[i].value);
  }
  // The gain, and the spring in steps.
  ASSERT_EQ(will.settings, 21u);
  EXPECT_EQ(will.setting[0].code, uint32_t{FF_GAIN});
  EXPECT_EQ(will.setting[0].value, 0xFFFF);
  EXPECT_EQ(will.setting[20].code, uint32_t{FF_AUTOCENTER});
  EXPECT_EQ(will.setting[20].value, 0xFFFF);
}

/// A player that stood still closes its device to open it again, and leaves the spring off for that
/// time. If it does not come back, nobody else turns it on.
TEST_F(ForceFeedbackFaults, SettingsReturnWhenAReopeningFails) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick, "hid-generic");
  auto board = std::make_unique<boards::ForceFeedback>("ff", load_profile(kDefaultProfile),
                                                       std::make_unique<EvdevTransport>("ff", ""),
                                                       boards::StickEffects::Updates::kOwnThread);
  const auto take_settings = [&] {
    board->open();
    boards::ForceReading reading;
    wait_for([&] {
      board->cycle({{1, 0, 0}, true}, reading, 0);
      return port.gain != 0xFFFF && port.gain != 0 && port.autocentre == 0;
    });
  };
  take_settings();
  board->expect_reopening();
  board->close();
  EXPECT_EQ(port.autocentre, 0);
  port.upload_error = ENOSPC;
  EXPECT_THROW(board->open(), DeviceError);
  board->close();
  EXPECT_EQ(port.autocentre, 0);
  port.upload_error = 0;
  board.reset();
  EXPECT_EQ(port.autocentre, 0xFFFF);
  EXPECT_EQ(port.gain, 0xFFFF);
}

/// Full gain would make an effect five times as strong that could not be stopped.
TEST_F(ForceFeedbackFaults, TheGainReturnsWhenEffectsHaveEnded) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick, "iforce");
  port.expires = true;
  {
    const FeltPlayer player;
    player.push(1, 0);
    wait_for([] { return evdev_levels(0).right != 0; });
    port.upload_error = EIO;
    port.refuses_stops = true;
  }
  EXPECT_EQ(port.gain, 0xFFFF);
  EXPECT_EQ(port.gain_with_force, 0);
}

/// The scheduling policy of a thread with this name.
int policy_of(const std::string& name) {
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string comm;
    std::getline(std::ifstream(task.path() / "comm"), comm);
    if (comm == name) return sched_getscheduler(std::stoi(task.path().filename()));
  }
  return -1;
}

TEST_F(ForceFeedbackFaults, UpdatesHaveRealTimePriorityWhereItIsAllowed) {
  bool allowed = false;
  std::thread([&] { allowed = request_real_time().real_time; }).join();
  if (!allowed) GTEST_SKIP() << "this process may not use real-time priority";
  plug_evdev(0, EvdevKind::kStick);
  const FeltPlayer player;
  wait_for([] { return policy_of("spidar-ff") == SCHED_FIFO; });
}

}  // namespace
}  // namespace spidar::test::force_feedback_faults_test
