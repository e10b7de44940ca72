// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A Novint Falcon through unmodified libusb, on an emulated bus: its firmware, and what can happen
/// on the way.
#include <unistd.h>

#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "tests/spidar/bus_test.h"
#include "tests/support/pushed_grip.h"
#include "tests/support/test.h"

namespace spidar::test::usb_falcon_test {
namespace {

constexpr uint16_t kHomed = 0x70;

class UsbFalcon : public BusTest {
 protected:
  UsbFalcon() {
    write_firmware(8492);  // bytes of the published one
    setenv("SPIDAR_FALCON_FIRMWARE", path.c_str(), 1);
  }
  ~UsbFalcon() override {
    unsetenv("SPIDAR_FALCON_FIRMWARE");
    std::filesystem::remove(path);
  }

  void write_firmware(size_t bytes) const {
    std::ofstream file(path, std::ios::binary);
    for (size_t i = 0; i < bytes; ++i) file.put(static_cast<char>(i * i >> 3));
  }
  static UsbPort& plug_homed(size_t port, const char* serial = "") {
    UsbPort& plugged = plug(port, "falcon", serial);
    plugged.inputs = kHomed;
    return plugged;
  }
  std::unique_ptr<Grip> grip(const std::string& spec = "falcon") const {
    return make_grip(spec, load_profile(kDefaultProfile), unguarded());
  }

  const std::string path =
      (std::filesystem::temp_directory_path() / ("falcon-" + std::to_string(getpid()))).string();
};

TEST_F(UsbFalcon, GetsItsFirmwareOnceAfterEachPlugIn) {
  UsbPort& port = plug_homed(1);
  const auto falcon = grip();
  for (int times = 0; times < 2; ++times) {
    ASSERT_EQ(opening(*falcon), "");
    EXPECT_TRUE(port.memory.loaded);
    EXPECT_EQ(falcon->description(), "at 1-2: Novint Falcon");
    for (int i = 0; i < 2; ++i) ASSERT_EQ(falcon->exchange(told(1)), LinkFault::kNone);
    EXPECT_FALSE(port.at_rest());
    falcon->close();
    // Without the file: it still has it.
    std::filesystem::remove(path);
  }
  plug_homed(1);
  expect_contains(opening(*falcon), path);
  write_firmware(8492);
  EXPECT_EQ(opening(*falcon), "");
}

TEST_F(UsbFalcon, SaysWhatIsWrongWithTheFirmware) {
  plug_homed(0);
  std::filesystem::remove(path);
  EXPECT_EQ(opening(*grip()), "falcon: has not got its firmware (timeout). " + path +
                                  ": it cannot be read: No such file or directory; "
                                  "SPIDAR_FALCON_FIRMWARE names the file, which is "
                                  "firmware/nvent_firmware.bin in the sources of libnifalcon");
  write_firmware(100'000);
  EXPECT_EQ(opening(*grip()), "falcon: " + path +
                                  " has 100000 bytes and is no firmware of a Falcon, which has "
                                  "some 8 kB");
  write_firmware(0);
  expect_contains(opening(*grip()), "is no firmware of a Falcon");
  setenv("SPIDAR_FALCON_FIRMWARE", "/tmp", 1);
  expect_contains(opening(*grip()), "/tmp: it is not a regular file");
  unsetenv("SPIDAR_FALCON_FIRMWARE");
  setenv("HOME", "/no/such/home", 1);
  expect_contains(opening(*grip()), "/no/such/home/.local/share/gst-spidar/novint-falcon.bin");
}

}  // namespace
}  // namespace spidar::test::usb_falcon_test
