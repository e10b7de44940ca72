// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Motors go to zero when the process that drives them is killed: another instance of this program,
/// with a device, and a file in which it reports that it pulls.
#include <cerrno>
#include <csignal>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "spidar/link/link_thread.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/shared_bus.h"
#include "tests/spidar/guardian_victim.h"
#include "tests/spidar/kinds.h"
#include "tests/support/pseudo_terminal.h"
#include "tests/support/pushed_grip.h"
#include "tests/support/recorded_motors.h"
#include "tests/support/test.h"

namespace spidar::test {
namespace {

/// An idle child with copies of all open files. It ends when another board is plugged in, or the
/// test has ended.
void leave_files_to_a_child() {
  const pid_t tester = getppid();
  if (fork() != 0) return;
  const int address = bus().port[0].address;
  while (bus().port[0].address == address && kill(tester, 0) == 0) sleep_1ms();
  _exit(0);
}

/// Pulls until it is killed, and again when the device was lost.
template <typename Opened, typename Exchange>
[[noreturn]] void exchange_for_ever(Opened& opened, const Exchange& exchange, bool forks) {
  opened.open();
  if (forks) leave_files_to_a_child();
  for (;;) {
    if (!is_lost(exchange())) continue;
    opened.close();
    opened.open();
  }
}

[[noreturn]] void pull_for_ever(const char* spec, const char* profile, bool forks) {
  if (board_info(spec).has_strings) {
    const auto device = make_device(spec, load_profile(profile));
    DeviceReading reading;
    exchange_for_ever(
        *device, [&] { return device->exchange(one_volt(), reading); }, forks);
  }
  const auto grip = make_grip(spec, load_profile(profile));
  exchange_for_ever(
      *grip, [&] { return grip->exchange(told(1)); }, forks);
}

/// Reads until it is killed. Moves the stick once it has its guardian and has read it.
[[noreturn]] void read_for_ever(const char* spec, const char* profile) {
  const auto grip = make_grip(spec, load_profile(profile));
  grip->open();
  for (int count = 0;; count += grip->exchange({}) == LinkFault::kNone) {
    if (count == 10) bus().evdev[0].axis[1] = 1;
    sleep_1ms();
  }
}

TEST(Guardian, ZeroesEachUsbDeviceWhenTheHostIsKilledOrStopped) {
  for (const DeviceKind& kind : devices()) {
    if (kind.usb.vendor == 0) continue;
    for (const int signal : {SIGKILL, SIGTERM, SIGABRT, SIGSTOP}) {
      UsbPort& port = plug(0, kind.board);
      port.memory.loaded = true;  // a Falcon's firmware
      port.inputs = 0x70;         // a Falcon is homed
      Victim victim(kind.device, kUsbProfile);
      victim.lives_until([&] { return !port.at_rest(); });
      victim.send(signal);
      wait_for([&] { return port.at_rest(); });
      victim.end(SIGKILL);
      clear_bus();
    }
  }
}

TEST(Guardian, ZeroesUsbBoardsWhenTheHostIsStopped) {
  for (const std::string& board : string_boards_on_usb()) {
    UsbPort& port = plug(0, board);
    Victim victim(kind_of(board).device, kUsbProfile);
    for (int times = 0; times < 3; ++times) {
      // A host that goes on has lost its board, and gets it and a new guardian by opening it again.
      victim.lives_until([&] { return port.digit[7] != 0; });
      victim.send(SIGSTOP);
      wait_for([&] { return port.at_rest(); });
      victim.send(SIGCONT);
    }
    victim.end(SIGKILL);
    wait_for([&] { return port.at_rest(); });
    clear_bus();
  }
}

TEST(Guardian, ZeroesUsbBoardsWhoseFilesAForkedChildHasToo) {
  UsbPort& port = plug(0, "sh4");
  Victim victim("usb", kUsbProfile, "--pull-and-fork");
  victim.lives_until([&] { return port.digit[7] != 0; });
  victim.end(SIGKILL);
  wait_for([&] { return port.at_rest(); });
  plug(0, "sh4");  // the child goes
  clear_bus();
}

/// The process lives, but the thread that drives the board waits in an application's callback.
TEST(Guardian, ZeroesABoardWhoseCallbackNeverReturns) {
  UsbPort& port = plug(0, "sh4");
  std::atomic<bool> hangs{false}, ends{false};
  HapticSession session(make_grip("usb", load_profile(kUsbProfile)));
  session.loop().callback().set([&](const CallbackInput&) {
    hangs = !port.at_rest();
    while (hangs && !ends) sleep_1ms();
    return Wrench{};
  });
  wait_for([&] { return hangs.load(); });
  wait_for([&] { return port.at_rest(); });
  EXPECT_TRUE(hangs) << "the callback has returned";
  ends = true;
  session.loop().callback().set({});
}

/// Settings are returned by the guardian when nobody else can; while the host may continue, the
/// centring spring stays off.
void joysticks_go_to_zero(const char* driver) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick, driver);
  const int spring = port.autocentre;
  for (const int signal : {SIGKILL, SIGTERM, SIGSTOP}) {
    Victim victim("ff", "spidar-g6x3-v2-r");
    victim.lives_until([&] { return !evdev_levels(0).at_rest(); });
    EXPECT_EQ(port.autocentre, 0);
    if (signal == SIGSTOP) {
      victim.send(signal);
      wait_for([&] { return evdev_levels(0).at_rest(); });
      const uint64_t settings = port.settings;
      // The guardian repeats its packets.
      std::this_thread::sleep_for(std::chrono::milliseconds(3 * kSilence_ms));
      EXPECT_EQ(port.autocentre, 0);
      EXPECT_EQ(port.settings, settings);
      victim.send(SIGCONT);
      // Gain and autocentre of the second opening. On a busy machine, a last effect of the first
      // one may come before it.
      wait_for([&] { return port.settings >= settings + 2 || !victim.lives(); });
      victim.lives_until([&] { return !evdev_levels(0).at_rest(); });
      victim.end(SIGKILL);
    } else {
      victim.end(signal);
    }
    wait_for([&] { return evdev_levels(0).at_rest(); });
    // When no process has the file any more, its effects are erased.
    wait_for([&] { return evdev_levels(0).at_rest() && !port.effect[0].used; });
    EXPECT_EQ(port.autocentre, spring);
    EXPECT_EQ(port.gain, 0xFFFF);
  }
  clear_bus();
}

TEST(Guardian, TakesJoysticksToZeroWhenTheHostIsKilledOrStopped) {
  joysticks_go_to_zero("iforce");
  joysticks_go_to_zero("hid-generic");
}

TEST(Guardian, ChangesNoSettingOfAJoystickThatNeverPulled) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick, "hid-generic");
  port.autocentre = 0x4000;  // by another program
  Victim victim("ff", "spidar-g6x3-v2-r", "--read");
  wait_for([&] { return port.plays >= 2 || !victim.lives(); });
  victim.lives_until([&] { return port.axis[1] != 0; });
  victim.end(SIGKILL);
  // The guardian has ended, too, when nobody holds the device any more.
  wait_for([&] { return evdev_levels(0).at_rest() && !port.effect[0].used; });
  EXPECT_EQ(port.autocentre, 0x4000);
  EXPECT_EQ(port.settings, 0u);
  clear_bus();
}

TEST(Guardian, ItsEndIsNoticedWhenItIsKilledOrStopped) {
  for (const bool threaded : {true, false}) {
    for (const int signal : {SIGKILL, SIGSTOP}) {
      UsbPort& port = plug(0, "sh4");
      boards::Settings settings;
      settings.threaded = threaded;
      const auto device = make_device("usb", load_profile(kUsbProfile), settings);
      device->open();
      DeviceReading reading;
      exchange_until(*device, one_volt(), [&] { return port.digit[7] != 0; });
      kill(guardian_process(), signal);
      wait_for([&] { return is_lost(device->exchange(one_volt(), reading)); });
      EXPECT_TRUE(port.at_rest());
      EXPECT_TRUE(is_lost(device->exchange(one_volt(), reading)));
      EXPECT_TRUE(port.at_rest());
      // On a busy machine, the guardian may have found that this process stood still before.
      const LinkFault fault = device->health().last_fault;
      EXPECT_TRUE(fault == LinkFault::kUnguarded || fault == LinkFault::kSuspended)
          << to_string(fault);
      device->close();
      EXPECT_EQ(guardian_process(), 0);
      device->open();
      EXPECT_NE(guardian_process(), 0);
      exchange_until(*device, one_volt(), [&] { return port.digit[7] != 0; });
      device->close();
      EXPECT_TRUE(port.at_rest());
      clear_bus();
    }
  }
}

TEST(Guardian, ZeroesUartBoardsWhenTheHostIsKilledOrStopped) {
  for (const int signal : {SIGKILL, SIGSTOP}) {
    MotorBench bench;
    UartLine line({std::make_shared<RecordedMotors>(bench), {{2, {7, 1, 8, 0, 4, 0}}}});
    Victim victim("uart:" + line.path(), kUartProfile);
    victim.lives_until([&] { return bench.digit[7] != 0; });
    victim.send(signal);
    wait_for([&] { return bench.all_zero(); });
  }
}

TEST(Guardian, GoesAwayWhenTheDeviceIsClosed) {
  UsbPort& port = plug(0, "sh4");
  {
    const auto device = make_device("usb", load_profile(kUsbProfile));
    for (int i = 0; i < 3; ++i) {
      device->open();
      device->close();
    }
    device->open();
  }
  // All of its children have been reaped.
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
  EXPECT_TRUE(port.at_rest());
  clear_bus();
}

TEST(Guardian, IsTriedWhenTheMotorsCannotBeZeroed) {
  UsbPort& port = plug(0, "sh4");
  const auto device = make_device("usb", load_profile(kUsbProfile));
  device->open();
  port.digit[0] = 100;
  port.fault = LinkFault::kStall;
  device->close();
  EXPECT_FALSE(port.at_rest());
  const pid_t trying = guardian_process();
  ASSERT_NE(trying, 0);
  port.fault = LinkFault::kNone;
  wait_for([&] { return port.at_rest(); });
  EXPECT_EQ(waitpid(trying, nullptr, 0), trying);
  clear_bus();
}

TEST(Guardian, IsRequiredUnlessDisabled) {
  plug(0, "sh4");
  const std::string before = std::getenv("SPIDAR_GUARDIAN");
  setenv("SPIDAR_GUARDIAN", "/nowhere/spidar-guardian", 1);
  const Profile profile = load_profile(kUsbProfile);
  EXPECT_EQ(opening(*make_device("usb", profile)),
            "usb: no guardian to zero the motors should this process be killed: "
            "/nowhere/spidar-guardian: No such file or directory; install spidar-guardian, or "
            "name it in SPIDAR_GUARDIAN");
  EXPECT_NO_THROW(make_device("usb", profile, unguarded())->open());
  setenv("SPIDAR_GUARDIAN", before.c_str(), 1);
  clear_bus();
}

/// Profilers and music programs have timers. Some calls fail then with EINTR, the receiving of an
/// answer with a limit even where the handler restarts calls.
TEST(Guardian, IsStartedInAProgramThatGetsSignals) {
  plug(0, "sh4");
  for (const int flags : {0, SA_RESTART}) {
    struct sigaction handler {
    }, before{};
    handler.sa_handler = [](int) {};
    handler.sa_flags = flags;
    sigaction(SIGALRM, &handler, &before);
    const itimerval often{{0, 1000}, {0, 1000}};
    setitimer(ITIMER_REAL, &often, nullptr);
    EXPECT_NO_THROW(make_device("usb", load_profile(kUsbProfile))->open());
    const itimerval never{};
    setitimer(ITIMER_REAL, &never, nullptr);
    sigaction(SIGALRM, &before, nullptr);
  }
  clear_bus();
}

}  // namespace
}  // namespace spidar::test

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--pull") == 0)
    spidar::test::pull_for_ever(argv[2], argv[3], false);
  if (argc == 4 && std::strcmp(argv[1], "--pull-when-plugged") == 0) {
    spidar::test::wait_for([] { return spidar::test::bus().port[0].kind != 0; });
    spidar::test::pull_for_ever(argv[2], argv[3], false);
  }
  if (argc == 4 && std::strcmp(argv[1], "--pull-and-fork") == 0)
    spidar::test::pull_for_ever(argv[2], argv[3], true);
  if (argc == 4 && std::strcmp(argv[1], "--read") == 0)
    spidar::test::read_for_ever(argv[2], argv[3]);
  // This process, its victims and their guardians have one bus.
  const spidar::test::SharedBus shared;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
