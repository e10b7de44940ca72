// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Joysticks, wheels and gamepads on emulated input devices, through the same calls as real ones.
#include <cerrno>

#include "spidar/devices/force_feedback/evdev_list.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "tests/spidar/bus_test.h"
#include "tests/spidar/force_bench.h"
#include "tests/support/felt_player.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::force_feedback_test {
namespace {

constexpr int64_t kMs = 1'000'000;
/// 20 % of 0xFFFF.
constexpr int kGain = 13107;

std::unique_ptr<Grip> grip(const std::string& spec = "ff") {
  return make_grip(spec, load_profile(kDefaultProfile), unguarded(true));
}

class ForceFeedback : public BusTest {};

TEST_F(ForceFeedback, IsListedWithoutBeingOpened) {
  plug_evdev(0, EvdevKind::kKeyboard);
  plug_evdev(1, EvdevKind::kPad);
  plug_evdev(2, EvdevKind::kStick);
  const std::vector<DeviceInfo> boards = list_boards();
  ASSERT_GE(boards.size(), 3u);
  EXPECT_EQ(boards[0].device, "ff:/dev/input/event2");
  EXPECT_EQ(boards[0].name, "Emulated Stick");
  EXPECT_EQ(boards[0].path, "/dev/input/event2");
  EXPECT_EQ(boards[0].usb_id, "1209:0001");
  EXPECT_STREQ(boards[0].evidence, "emulated");
  EXPECT_EQ(boards[0].note, "");
  EXPECT_FALSE(boards[0].has_strings);
  EXPECT_TRUE(boards[0].accessible);
  EXPECT_EQ(boards[1].device, "ff:/dev/input/event1");
  EXPECT_EQ(boards[1].note, "rumble only: strength without direction");
  EXPECT_EQ(boards[2].device, "sim");
  for (const EvdevPort& port : bus().evdev) EXPECT_EQ(port.uploads, 0u);
  EXPECT_EQ(board_info("ff:/dev/input/event2").name, "Emulated Stick");
  EXPECT_FALSE(board_info("ff").name.empty());
}

TEST_F(ForceFeedback, RightIsRightAndUpIsUp) {
  plug_evdev(0, EvdevKind::kStick);
  const FeltPlayer player;
  EXPECT_EQ(player.session->opened(),
            "Emulated Stick at 20 % of its strength, force feedback on two axes");
  const GripAbilities can = player.session->grip().abilities();
  EXPECT_TRUE(can.force[0] && can.force[1] && can.direction);
  EXPECT_FALSE(can.force[2] || can.torque);
  EXPECT_EQ(can.position, (std::array<bool, 3>{true, true, false}));
  for (const auto& [x_N, y_N] :
       {std::pair{1.5, 0.0}, {-0.7, 0.0}, {0.0, 2.0}, {0.0, -0.2}, {1.0, -1.2}, {0.0, 0.0}}) {
    player.push(x_N, y_N);
    const double size_N = std::hypot(x_N, y_N);
    wait_for([&, x = x_N, y = y_N] {
      const EvdevLevels levels = evdev_levels(0);
      return is_level(levels.right, x, size_N) && is_level(levels.up, y, size_N);
    });
    // Forces are still being switched on when the first one comes.
    wait_for([&, x = x_N, y = y_N] {
      return player.now().last.delivered.force_N == Eigen::Vector3d(x, y, 0);
    });
  }
}

TEST_F(ForceFeedback, PadsGetTheStrengthOfTheForce) {
  plug_evdev(0, EvdevKind::kPad);
  const FeltPlayer player;
  EXPECT_EQ(player.session->grip().description(),
            "Emulated Pad, rumble only: the strength of the force is felt, not its direction");
  EXPECT_TRUE(player.session->grip().abilities().force[1]);
  EXPECT_FALSE(player.session->grip().abilities().direction);
  player.push(-0.9, 1.2);
  wait_for([] {
    const EvdevLevels levels = evdev_levels(0);
    return levels.right == 0 && levels.up == 0 &&
           std::abs(levels.rumble - 0.5 * ff::kFullStrength) <= 0.005 * ff::kFullStrength;
  });
}

TEST_F(ForceFeedback, ButtonsAreNumberedAsByTheKernelsJoystickDriver) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  const FeltPlayer player;
  EXPECT_EQ(player.session->grip().abilities().buttons, 3);
  EXPECT_EQ(player.now().last.buttons, 0u);
  port.pressed = 0b011;  // BTN_0, which comes last, and BTN_TRIGGER, which comes first
  wait_for([&] { return player.now().last.buttons == 0b101; });
  port.pressed = 0b100;  // BTN_THUMB
  wait_for([&] { return player.now().last.buttons == 0b010; });
}

TEST_F(ForceFeedback, TheStickIsTheGripAndRestsAnywhere) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  const FeltPlayer player;
  port.axis[0] = 1000;
  port.axis[1] = 500;
  // Half of the way to the exits, which are at 59 and 64 mm; a reading is rounded to 3 µm.
  wait_for([&] {
    return (player.now().last.pose.position_m - Eigen::Vector3d(0.0295, -0.016, 0)).norm() < 1e-5;
  });
  EXPECT_TRUE(evdev_levels(0).at_rest());
  // Far from the centre as well as there, and as strong as it can.
  player.push(2, 2);
  wait_for([&] {
    const EvdevLevels levels = evdev_levels(0);
    return is_level(levels.right, 2, 2) && is_level(levels.up, 2, 2);
  });
  player.push(0, 0);
  wait_for([] { return evdev_levels(0).at_rest(); });
}

TEST_F(ForceFeedback, UpdatesAreRareAndNeverUnnecessary) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick);
  const int64_t opened_ns = HapticSession::monotonic_now_ns();
  {
    const FeltPlayer player;
    port.shortest_ns = 0;  // without those of opening it
    // Another force every millisecond.
    const int64_t begin_ns = HapticSession::monotonic_now_ns();
    for (int i = 1; i <= 200; ++i) {
      while (!player.loop().schedule(
          lasting({std::sin(0.1 * i), std::cos(0.1 * i), 0}, kSecond_ns + i * 5 * kMs)))
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    wait_for([&] { return HapticSession::monotonic_now_ns() - begin_ns > kSecond_ns; });
    EXPECT_GT(port.uploads, 4u);
    player.push(0, 0);
    wait_for([] { return evdev_levels(0).at_rest(); });
  }
  EXPECT_GE(port.shortest_ns, boards::ForceFeedback::kUpdate_ms * kMs);
  EXPECT_EQ(port.unchanged, 0u);
  // Each of two effects, when it was opened, and at most once every kRefresh_ms of the time since.
  const int64_t lasted_ms = (HapticSession::monotonic_now_ns() - opened_ns) / kMs;
  EXPECT_LE(static_cast<int64_t>(port.plays),
            2 + 2 * (lasted_ms / boards::StickEffects::kRefresh_ms + 1));
}

/// A device whose spring was off before must not be left with a spring that pushes the hand.
TEST_F(ForceFeedback, TheCentringSpringReturnsOnlyWhereTheDriverHadTurnedItOn) {
  struct Case {
    const char* driver;
    int before, after;
  };
  for (const auto& [driver, before, after] : {Case{"logitech", 0, 0},
                                              {"logitech", 0x4000, 0},
                                              {"iforce", 0, 0},
                                              {"unheard-of", 0x4000, 0},
                                              {"", 0xFFFF, 0},
                                              {"hid-generic-like", 0xFFFF, 0},
                                              {"hid-generic", 0xFFFF, 0xFFFF},
                                              {"hid-universal-pidff", 0xFFFF, 0xFFFF}}) {
    SCOPED_TRACE(driver);
    EvdevPort& port = plug_evdev(0, EvdevKind::kStick, driver);
    port.gain = 100;
    port.autocentre = before;
    {
      const FeltPlayer player;
      player.push(1, 0);
      wait_for([&] { return port.gain == kGain && port.autocentre == 0; });
    }
    EXPECT_EQ(port.autocentre, after);
    EXPECT_EQ(port.gain, 0xFFFF);
    EXPECT_TRUE(evdev_levels(0).at_rest());
    for (const EvdevPort::Effect& effect : port.effect) EXPECT_FALSE(effect.used);
  }
}

TEST_F(ForceFeedback, TheCentringSpringReturnsByARamp) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick, "hid-generic");
  {
    const FeltPlayer player;
    wait_for([&] { return port.autocentre == 0; });
    EXPECT_EQ(port.settings, 2u);
  }
  EXPECT_EQ(port.autocentre, 0xFFFF);
  // Gain, and every 5 ms for 100 ms.
  EXPECT_EQ(port.settings, 2u + 1u + 20u);
}

/// As spidarctl info and zero do.
TEST_F(ForceFeedback, AnExchangeOfZerosChangesNoSetting) {
  for (const char* driver : {"logitech", "hid-generic"}) {
    EvdevPort& port = plug_evdev(0, EvdevKind::kStick, driver);
    const int before = port.autocentre;
    const auto device = grip();
    device->open();
    // Until the thread that sets levels has shown the position twice, so it has done an update.
    const auto read_m = [&] {
      wait_for([&] { return device->exchange({}) == LinkFault::kNone; });
      return device->reading().pose.position_m;
    };
    for (const int at : {1000, -1000}) {
      const Eigen::Vector3d first_m = read_m();
      port.axis[0] = at;
      wait_for([&] { return read_m() != first_m; });
    }
    device->close();
    EXPECT_EQ(port.settings, 0u) << driver;
    EXPECT_EQ(port.autocentre, before) << driver;
  }
}

TEST_F(ForceFeedback, TheDriverIsFoundThroughALink) {
  plug_evdev(2, EvdevKind::kWheel);
  EXPECT_EQ(evdev_driver("/dev/input/event2"), "logitech");
  EXPECT_EQ(evdev_driver("/dev/input/event3"), "");
  const TemporaryFolder folder;
  const std::string file = (folder.path / "event2").string(),
                    link = (folder.path / "by-id").string();
  fclose(fopen(file.c_str(), "w"));
  std::filesystem::create_symlink(file, link);
  EXPECT_EQ(evdev_driver(link), "logitech");
}

/// The loop's own ramp, and one update for each axis, in ticks.
TEST_F(ForceFeedback, IsAtZeroWithin60MsOfAPause) {
  ForceBench bench("ff");
  HapticSession session(bench.grip(), by_hand());
  int64_t now_ns = 0;
  const auto tick = [&] {
    now_ns += kTick_ns;
    session.loop().tick(now_ns, now_ns);
  };
  session.loop().set_playback_clock({0, 0, 1.0, true});
  ASSERT_TRUE(session.loop().schedule(lasting({2, -2, 0})));
  // Until forces are switched on, and this one is there.
  while (now_ns < static_cast<int64_t>(HapticLoop::kEnergise_s * 1e9)) tick();
  while (session.loop().snapshot().last.commanded.force_N.x() != 2) tick();
  for (int i = 0; i < 2 * boards::ForceFeedback::kUpdate_ms; ++i) tick();
  EXPECT_TRUE(is_level(bench.motors.digit[0], 2, 2));
  EXPECT_TRUE(is_level(bench.motors.digit[1], -2, 2));
  session.loop().set_playback_clock({now_ns, 0, 1.0, false});
  for (int ms = 0; ms < 60; ++ms) tick();
  EXPECT_TRUE(bench.motors.all_zero());
}

/// A name is what a device says of itself: a terminal must not obey it.
TEST_F(ForceFeedback, ItsNameIsHarmless) {
  plug_evdev(0, EvdevKind::kStick, nullptr, {"\x1b[2J", nullptr, "\x1b]0;title\x07\x9bStick"});
  const std::vector<DeviceInfo> boards = list_boards();
  EXPECT_EQ(boards[0].name, "?]0;title??Stick");
  EXPECT_EQ(boards[0].serial, "?[2J");
  {
    const FeltPlayer player;
    EXPECT_EQ(player.session->opened(),
              "?]0;title??Stick at 20 % of its strength, force feedback on two axes");
  }
  bus().evdev[0].upload_error = ENOSPC;
  expect_contains(opening(*grip()), "\"?]0;title??Stick\" does not take");
}

TEST_F(ForceFeedback, OpeningSaysWhatIsWrong) {
  const auto says = [](const std::string& spec, const std::string& what) {
    expect_contains(opening(*grip(spec)), what);
  };
  says("ff", "no joystick, wheel or gamepad with force feedback is plugged in");
  says("ff:/dev/input/event7", "spidarctl list names");
  const TemporaryFolder folder;
  const std::string file = (folder.path / "file").string();
  fclose(fopen(file.c_str(), "w"));
  says("ff:" + file, "it is no input device");
  plug_evdev(0, EvdevKind::kKeyboard);
  says("ff", "the kernel has no driver for it");
  says("ff:/dev/input/event0", "\"Emulated Keyboard\" has no force feedback");
  EvdevPort& port = plug_evdev(1, EvdevKind::kStick);
  port.upload_error = ENOSPC;
  says("ff",
       "\"Emulated Stick\" does not take an effect: No space left on device; close other programs");
  port.upload_error = EINVAL;
  says("ff", "does not take an effect: Invalid argument; its driver does not support this effect");
  port.upload_error = ENOSYS;
  says("ff", "Function not implemented; its driver does not support this effect");
  port.upload_error = EIO;
  says("ff", "does not take an effect: Input/output error; plug the device in again");
  port.upload_error = 0;
  EXPECT_EQ(opening(*grip()), "");
  // Without a loop, which may lose it for a moment on a busy machine.
  const auto first = grip();
  first->open();
  says("ff:/dev/input/event1", "another program uses it");
}

}  // namespace
}  // namespace spidar::test::force_feedback_test
