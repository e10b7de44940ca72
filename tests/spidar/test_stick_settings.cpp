// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// spidarctl selftest on a joystick or gamepad of the emulated bus.
#include <csignal>

#include "tests/emulated_bus/bus_state.h"
#include "tests/spidar/guardian_victim.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::stick_settings_test {
namespace {

class StickSettings : public testing::Test {
 protected:
  StickSettings() { clear_bus(); }
  ~StickSettings() override { clear_bus(); }

  /// What it prints is in log().
  ChildProcess selftest() const {
    return ChildProcess(
        {"sh", "-c", "exec " SPIDARCTL " selftest ff --yes >" + log_.string() + " 2>&1"},
        {"LD_PRELOAD=" EMULATED_BUS_LIBRARY});
  }
  std::string log() const {
    std::ifstream file(log_);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// It got no processor time, however often it began again, or what it needs got none.
  bool is_given_up() const { return is_disturbed(log()); }

 private:
  const TemporaryFolder folder_;
  const std::filesystem::path log_ = folder_.path / "log";
};

TEST_F(StickSettings, AreReturnedHoweverASelftestEnds) {
  EvdevPort& port = plug_evdev(0, EvdevKind::kStick, "hid-generic");
  for (const bool stopped : {false, true}) {
    for (const int signal : {SIGTERM, SIGQUIT, SIGKILL}) {
      ChildProcess test = selftest();
      wait_for(
          [&] { return (!evdev_levels(0).at_rest() && port.autocentre == 0) || !test.lives(); });
      if (is_given_up()) GTEST_SKIP() << log();
      ASSERT_TRUE(test.lives()) << log();
      if (stopped) {
        test.send(SIGSTOP);
        wait_for([&] { return evdev_levels(0).at_rest(); });
        if (signal != SIGKILL) test.send(SIGCONT);
      }
      test.end(signal);
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
  ChildProcess test = selftest();
  wait_for([&] { return !evdev_levels(0).at_rest() || !test.lives(); });
  if (is_given_up()) GTEST_SKIP() << log();
  ASSERT_TRUE(test.lives()) << log();
  test.send(SIGSTOP);
  wait_for([&] { return evdev_levels(0).at_rest(); });
  test.send(SIGCONT);
  const int status = test.wait();
  // Gain and autocentre are set and returned each of the ten times that it begins a push again.
  if (is_given_up() && (!stood_still(log()) || port.settings >= 40)) GTEST_SKIP() << log();
  // This stick does not move.
  EXPECT_EQ(status, 1) << log();
  EXPECT_NE(log().find("right    does not move"), std::string::npos) << log();
  EXPECT_EQ(port.gain, 0xFFFF);
  EXPECT_EQ(port.autocentre, 0xFFFF);
}

/// Its sticks are no grip that a force could move.
TEST_F(StickSettings, APadThatOnlyRumblesRumbles) {
  const EvdevPort& port = plug_evdev(0, EvdevKind::kPad);
  const int status = selftest().wait();
  if (is_given_up()) GTEST_SKIP() << log();
  EXPECT_EQ(status, 0) << log();
  EXPECT_NE(log().find("strength  a pulse of 0.5 s"), std::string::npos) << log();
  EXPECT_EQ(log().find("does not move"), std::string::npos) << log();
  EXPECT_GT(port.plays, 0u);
  EXPECT_TRUE(evdev_levels(0).at_rest());
}

}  // namespace
}  // namespace spidar::test::stick_settings_test
