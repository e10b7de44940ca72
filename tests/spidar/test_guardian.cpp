/// Motors come to zero when the process that drives them is killed.
///
/// The process to be killed is this program again, with a device and a file to say that it pulls.
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

#include "spidar/boards/board_device.h"
#include "spidar/device_factory.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/shared_bus.h"
#include "tests/support/child_process.h"
#include "tests/support/pseudo_terminal.h"
#include "tests/support/recorded_motors.h"

namespace spidar::test {
namespace {

constexpr const char* kUsbProfile = "spidar-g6x3-v2-r";
constexpr const char* kUartProfile = "spidar-g6x5-r";

/// Pulls until it is killed.
[[noreturn]] void pull_for_ever(const char* spec, const char* profile) {
  const auto device = make_device(spec, load_profile(profile));
  device->open();
  MotorVolts volts;
  volts.volt.fill(1);
  DeviceReading reading;
  for (;;) device->exchange(volts, reading);
}

/// This program, pulling.
class Victim : public ChildProcess {
 public:
  Victim(const std::string& spec, const std::string& profile)
      : ChildProcess({"/proc/self/exe", "--pull", spec, profile}) {}
};

/// Waits for as long as it takes; the test's own time limit is the only one.
template <typename Condition>
void wait_for(const Condition& condition) {
  while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(Guardian, ZeroesUsbBoardsWhenTheHostIsKilled) {
  for (const UsbKind kind : {UsbKind::kSh4, UsbKind::kSimple}) {
    for (const int signal : {SIGKILL, SIGTERM, SIGABRT}) {
      UsbPort& port = plug(0, kind);
      Victim victim("usb", kUsbProfile);
      wait_for([&] { return port.digit[7] != 0 || !victim.lives(); });
      ASSERT_TRUE(victim.lives());
      victim.end(signal);
      wait_for([&] { return port.at_rest(); });
      clear_bus();
    }
  }
}

TEST(Guardian, StopsTheMouseWhenTheHostIsKilled) {
  UsbPort& port = plug(0, UsbKind::kMouse);
  Victim victim("mouse", "spidar-g6x3-v1-r");
  // Equal volts of all strings cancel out up to rounding: look for the reports instead.
  wait_for([&] { return port.updates > 2 || !victim.lives(); });
  ASSERT_TRUE(victim.lives());
  port.digit[0] = 500;
  victim.end(SIGKILL);
  wait_for([&] { return port.at_rest(); });
  clear_bus();
}

TEST(Guardian, ZeroesUartBoardsWhenTheHostIsKilled) {
  MotorBench bench;
  RecordedMotors motors(bench);
  UartLine line({motors, {{2, {7, 1, 8, 0, 4, 0}}}});
  Victim victim("uart:" + line.path(), kUartProfile);
  wait_for([&] { return bench.digit[7] != 0 || !victim.lives(); });
  ASSERT_TRUE(victim.lives());
  victim.end(SIGKILL);
  wait_for([&] { return bench.all_zero(); });
}

TEST(Guardian, GoesAwayWhenTheDeviceIsClosed) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  {
    const auto device = make_device("usb", load_profile(kUsbProfile));
    for (int i = 0; i < 3; ++i) {
      device->open();
      device->close();
    }
    device->open();
  }
  // All of its children have been waited for.
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
  EXPECT_TRUE(port.at_rest());
  clear_bus();
}

TEST(Guardian, IsTriedWhenTheMotorsCannotBeZeroed) {
  UsbPort& port = plug(0, UsbKind::kSh4);
  const auto device = make_device("usb", load_profile(kUsbProfile));
  device->open();
  port.digit[0] = 100;
  port.fault = LinkFault::kStall;
  device->close();  // the guardian has given up, too
  EXPECT_FALSE(port.at_rest());
  clear_bus();
}

TEST(Guardian, IsNeededUnlessNotWanted) {
  plug(0, UsbKind::kSh4);
  const std::string before = std::getenv("SPIDAR_GUARDIAN");
  setenv("SPIDAR_GUARDIAN", "/nowhere/spidar-guardian", 1);
  const Profile profile = load_profile(kUsbProfile);
  try {
    make_device("usb", profile)->open();
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_STREQ(error.what(),
                 "usb: no guardian to zero the motors should this process be killed: "
                 "/nowhere/spidar-guardian: No such file or directory; install spidar-guardian, or "
                 "name it in SPIDAR_GUARDIAN");
  }
  BoardSettings settings;
  settings.guardian = false;
  EXPECT_NO_THROW(make_device("usb", profile, settings)->open());
  setenv("SPIDAR_GUARDIAN", before.c_str(), 1);
  clear_bus();
}

}  // namespace
}  // namespace spidar::test

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], "--pull") == 0)
    spidar::test::pull_for_ever(argv[2], argv[3]);
  // This process, its victims and their guardians have one bus.
  const spidar::test::SharedBus shared;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
