// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What test_boards and test_force_feedback_faults demand of a board, of device=ff through a real
/// kernel's evdev: faults of the driver, and forces that no device can give.
#include <cerrno>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "spidar/boards/board.h"
#include "spidar/session/device_factory.h"
#include "tests/kernel/uinput_device.h"
#include "tests/support/felt_player.h"
#include "tests/support/pushed_grip.h"

namespace spidar::test::kernel_evdev_faults_test {
namespace {

std::unique_ptr<Grip> board(const Profile& profile, const std::string& name = "uinput device") {
  BoardSettings settings;
  settings.guardian = false;
  return make_grip(listed(name), profile, settings);
}

class KernelEvdevFaults : public testing::Test {
 protected:
  UinputDevice stick{UinputKind::kStick};
  const Profile profile = load_profile(kDefaultProfile);
};

TEST_F(KernelEvdevFaults, OpenLeavesItAtRestAndCloseErasesItsEffects) {
  const auto device = board(profile);
  device->open();
  EXPECT_TRUE(stick.at_rest());
  EXPECT_TRUE(stick.has_effects());
  wait_for([&] {
    device->exchange(told(0.1));
    return !stick.at_rest();
  });
  device->close();
  EXPECT_TRUE(stick.at_rest());
  EXPECT_FALSE(stick.has_effects());
  EXPECT_EQ(device->exchange({}), LinkFault::kGone);
}

TEST_F(KernelEvdevFaults, ForcesBeyondFullLevelAreCutAndWhatIsNoNumberPushesNowhere) {
  UinputDevice pad(UinputKind::kPad, "uinput pad");
  const auto of_stick = board(profile);
  const auto of_pad = board(profile, "uinput pad");
  of_stick->open();
  of_pad->open();
  const auto until = [&](double right_N, const auto& reached) {
    wait_for([&] {
      for (const auto& device : {of_stick.get(), of_pad.get()}) {
        EXPECT_EQ(device->exchange(told(right_N)), LinkFault::kNone);
      }
      return reached();
    });
  };
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    until(1e9,
          [&] { return stick.right() == ff::kFullLevel && pad.rumble() == ff::kFullStrength; });
    EXPECT_EQ(stick.up(), 0);
    until(bad, [&] { return stick.at_rest() && pad.at_rest(); });
  }
}

TEST_F(KernelEvdevFaults, AfterEveryErrorItComesToRestAndTheForceReturns) {
  const FeltPlayer player(listed());
  for (const int error : {EIO, ENOSPC, EINVAL, ETIMEDOUT}) {
    SCOPED_TRACE(std::strerror(error));
    player.push(1, 0);
    wait_for([&] { return is_level(stick.right(), 1, 1); });
    stick.upload_error = error;
    player.loop().cancel_scheduled();
    ASSERT_TRUE(player.loop().schedule(lasting({0, 1, 0})));
    wait_for([&] { return player.now().last.device == DeviceState::kLost; });
    const LinkFault fault = player.session->grip().health().last_fault;
    EXPECT_EQ(fault == LinkFault::kBusError, error == EIO) << to_string(fault);
    EXPECT_EQ(fault == LinkFault::kTimeout, error == ETIMEDOUT) << to_string(fault);
    // The last level does not remain.
    wait_for([&] { return stick.at_rest(); });
    stick.upload_error = 0;
    wait_for([&] { return is_level(stick.up(), 1, 1) && stick.right() == 0; });
  }
}

TEST_F(KernelEvdevFaults, OpenSaysWhatIsWrong) {
  const auto device = board(profile);
  stick.upload_error = EIO;
  try {
    device->open();
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("\"uinput device\" does not take an effect"),
              std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(stick.has_effects());
  stick.upload_error = 0;
  device->open();
  EXPECT_EQ(device->exchange({}), LinkFault::kNone);
}

}  // namespace
}  // namespace spidar::test::kernel_evdev_faults_test
