// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A host that lives and says nothing: whether its guardian acts depends on what the board was told
/// last.
#include "spidar/link/link_thread.h"
#include "spidar/session/device_factory.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/spidar/guardian_victim.h"
#include "tests/support/test.h"

namespace spidar::test {
namespace {

TEST(Guardian, LeavesAHostAloneThatIsSilentAtRest) {
  UsbPort& port = plug(0, "sh4");
  const auto device = make_device("usb", load_profile(kUsbProfile));
  device->open();
  for (int times = 0; times < 3; ++times) {
    exchange_until(*device, one_volt(), [&] { return !port.at_rest(); });
    exchange_until(*device, {}, [&] { return port.at_rest(); });
    std::this_thread::sleep_for(std::chrono::milliseconds(2 * kSilence_ms));
  }
  DeviceReading reading;
  wait_for([&] { return device->exchange(one_volt(), reading) != LinkFault::kTimeout; });
  EXPECT_EQ(device->health().count(LinkFault::kUnguarded), 0u);
  device->close();
  clear_bus();
}

/// The board may never have got the zeros, and goes on pulling.
TEST(Guardian, ZeroesABoardWhoseHostIsSilentAfterZerosThatFailed) {
  UsbPort& port = plug(0, "sh4");
  boards::Settings settings;
  settings.threaded = false;  // so that nothing is exchanged after this
  const auto device = make_device("usb", load_profile(kUsbProfile), settings);
  device->open();
  exchange_until(*device, one_volt(), [&] { return !port.at_rest(); });
  DeviceReading reading;
  port.fault = LinkFault::kStall;
  EXPECT_NE(device->exchange({}, reading), LinkFault::kNone);
  port.fault = LinkFault::kNone;
  wait_for([&] { return port.at_rest(); });
  device->close();
  clear_bus();
}

}  // namespace
}  // namespace spidar::test
