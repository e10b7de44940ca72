// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidarctl selftest on a joystick or gamepad of the emulated bus.
#include <csignal>

#include "tests/spidar/bus_test.h"
#include "tests/spidar/guardian_victim.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::stick_settings_test {
namespace {

class StickSettings : public BusTest {
 protected:
  /// What it prints is in log().
  std::unique_ptr<ChildProcess> selftest() const {
    return std::make_unique<ChildProcess>(
        std::vector<std::string>{
            "sh", "-c", "exec " SPIDARCTL " selftest ff --yes >" + log_.string() + " 2>&1"},
        std::vector<std::string>{"LD_PRELOAD=" EMULATED_BUS_LIBRARY});
  }
  /// One that pulls. It is begun again where the machine was too busy for it.
  template <typename Pulls>
  std::unique_ptr<ChildProcess> selftest_until(const Pulls& pulls) const {
    for (;;) {
      std::unique_ptr<ChildProcess> test = selftest();
      wait_for([&] { return pulls() || !test->lives(); });
      if (test->lives() || !is_disturbed(log())) return test;
    }
  }
  std::string log() const {
    std::ifstream file(log_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  const TemporaryFolder folder_;
  const std::filesystem::path log_ = folder_.path / "log";
};

TEST_F(StickSettings, AreReturnedHoweverASelftestEnds) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick, "hid-generic");
  for (const bool stopped : {false, true}) {
    for (const int signal : {SIGTERM, SIGQUIT, SIGKILL}) {
      const auto test =
          selftest_until([&] { return !evdev_levels(0).at_rest() && port.autocentre == 0; });
      ASSERT_TRUE(test->lives()) << log();
      if (stopped) {
        test->send(SIGSTOP);
        wait_for([&] { return evdev_levels(0).at_rest(); });
        if (signal != SIGKILL) test->send(SIGCONT);
      }
      test->end(signal);
      // Nobody has the device any more.
      wait_for([&] {
        return evdev_levels(0).at_rest() && !port.effect[0].used && port.gain == 0xFFFF &&
               port.autocentre == 0xFFFF;
      });
    }
  }
}

/// The whole test, which a stop disturbs in one push only.
TEST_F(StickSettings, ASelftestThatStoodStillGoesOn) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick, "hid-generic");
  int status = 0;
  // Again where it has given up because of the machine: gain and autocentre are set and returned
  // each of the ten times that it begins a push again.
  do {
    port.settings = 0;
    const auto test = selftest_until([] { return !evdev_levels(0).at_rest(); });
    ASSERT_TRUE(test->lives()) << log();
    test->send(SIGSTOP);
    wait_for([&] { return evdev_levels(0).at_rest(); });
    test->send(SIGCONT);
    status = test->wait();
  } while (is_disturbed(log()) && (!was_suspended(log()) || port.settings >= 40));
  // This stick does not move.
  EXPECT_EQ(status, 1) << log();
  expect_contains(log(), "right    does not move");
  EXPECT_EQ(port.gain, 0xFFFF);
  EXPECT_EQ(port.autocentre, 0xFFFF);
}

/// Its sticks are no grip that a force could move.
TEST_F(StickSettings, APadThatOnlyRumblesRumbles) {
  const EvdevPort& port = plug_evdev(0, EvdevKind::kPad);
  int status = 0;
  do {
    status = selftest()->wait();
  } while (is_disturbed(log()));
  EXPECT_EQ(status, 0) << log();
  expect_contains(log(), "strength  a pulse of 0.5 s");
  EXPECT_EQ(log().find("does not move"), std::string::npos) << log();
  EXPECT_GT(port.plays, 0u);
  EXPECT_TRUE(evdev_levels(0).at_rest());
}

}  // namespace
}  // namespace spidar::test::stick_settings_test
