// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// USB boards through unmodified libusb, on an emulated bus.
#include <cerrno>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "spidar/devices/device_registry.h"
#include "spidar/devices/inverse3/packets.h"
#include "spidar/link/link_thread.h"
#include "spidar/session/board_list.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/profile_choice.h"
#include "tests/spidar/board_bench.h"
#include "tests/spidar/bus_test.h"
#include "tests/support/pushed_grip.h"
#include "tests/support/test.h"

namespace spidar::test::usb_boards_test {
namespace {

/// Exchanges until the answer is as given, however slow the machine is.
void exchange_until(StringDevice& device, LinkFault wanted, DeviceReading& reading) {
  while (device.exchange(all_volts(1), reading) != wanted) {
  }
}

class UsbBoards : public BusTest {
 protected:
  std::unique_ptr<StringDevice> device(const std::string& spec = "usb",
                                       bool threaded = true) const {
    return make_device(spec, profile, unguarded(threaded));
  }

  const Profile profile = load_profile("spidar-g645");  // its source names no board
};

class EachUsbBoard : public UsbBoards, public testing::WithParamInterface<std::string> {
 protected:
  std::unique_ptr<StringDevice> only_device(bool threaded) const {
    return device(kind_of(GetParam()).device, threaded);
  }
};
INSTANTIATE_TEST_SUITE_P(, EachUsbBoard, testing::ValuesIn(string_boards_on_usb()), name_of);

TEST_F(UsbBoards, AreListedWithoutBeingOpened) {
  plug(0, "sh4", "A1");
  plug(2, "simple").forbidden = true;
  plug(3, "mouse");
  const std::vector<DeviceInfo> boards = list_boards();
  ASSERT_GE(boards.size(), 4u);
  EXPECT_EQ(boards[0].device, "usb:1-1");
  EXPECT_EQ(boards[0].name, "CyVerse USB 2.0 SH4");
  EXPECT_EQ(boards[0].path, "1-1");
  EXPECT_EQ(boards[0].serial, "A1");
  EXPECT_EQ(boards[0].usb_id, "0cec:0205");
  EXPECT_STREQ(boards[0].evidence, "emulated");
  EXPECT_TRUE(boards[0].accessible);
  EXPECT_EQ(boards[1].device, "usb:1-3");
  EXPECT_FALSE(boards[1].accessible);
  expect_contains(boards[1].note, "70-spidar.rules");
  EXPECT_EQ(boards[2].device, "mouse:1-4");
  EXPECT_STREQ(boards[2].evidence, "inferred");
  EXPECT_EQ(boards[3].device, "sim");
  for (const UsbPort& port : bus().port) EXPECT_EQ(port.updates, 0u);
}

TEST_F(UsbBoards, AreKnownByWhatTheyAreCalled) {
  EXPECT_EQ(board_info("usb").name.find("CyVerse USB 2.0 SH4 or "), 0u);
  EXPECT_STREQ(board_info("mouse").evidence, "inferred");
  EXPECT_FALSE(board_info("sim:mouse").has_strings);
  EXPECT_TRUE(board_info("foo").name.empty());
  plug(0, "sh4", "A1");
  EXPECT_EQ(board_info("usb").device, "usb:1-1");
  EXPECT_EQ(board_info("usb:A1").path, "1-1");
  EXPECT_EQ(board_info("usb:1-1").name, "CyVerse USB 2.0 SH4");
  plug(1, "simple");
  EXPECT_EQ(board_info("usb").path, "");
  const DeviceInfo line = board_info("uart:/no/such/line");
  EXPECT_EQ(line.path, "/no/such/line");
  EXPECT_FALSE(line.accessible);
  // What has a profile without a name can drive it.
  std::vector<std::string> named{"ff:/dev/input/event0"};
  for (const DeviceKind& kind : devices()) {
    if (kind.has_strings() || kind.needs_rest()) continue;
    named.emplace_back(kind.device);
    if (kind.usb.vendor != 0) named.push_back(std::string(kind.device) + ":1-4");
  }
  for (const DeviceInfo& board : list_boards())
    if (is_simulated(board.device)) named.push_back(board.device);
  for (const std::string& device : named)
    EXPECT_NO_THROW(make_grip(device, profile_for(device, ""))) << device;
}

/// Haply's service, where it runs, is not connected to for somebody who has named a board.
TEST_F(UsbBoards, AreLookedForWithoutAskingOtherDevices) {
  const int service = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(inverse3::kPort);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const bool listens = bind(service, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0 &&
                       listen(service, 1) == 0;
  plug(0, "sh4", "A1");
  EXPECT_EQ(board_info("usb").path, "1-1");
  const bool asked = accept(service, nullptr, nullptr) >= 0;
  EXPECT_FALSE(asked);
  EXPECT_EQ(board_info("inverse3").path.empty(), !listens);
  close(service);
  if (!listens) GTEST_SKIP() << "the port of Haply's service is in use";
}

TEST_F(UsbBoards, AreFoundByPathSerialOrRotarySwitch) {
  plug(0, "sh4", "SN-5").inputs = 0x30;
  plug(1, "simple").inputs = 0x70;
  plug(2, "sh4").inputs = 0x90;
  struct Case {
    const char* spec;
    size_t port;
    const char* description;
  };
  const char* simple_board = "at 1-2: CyVerse USB 2.0 Simple, rotary switch 7";
  for (const Case c : {Case{"usb:1-2", 1, simple_board}, Case{"usb:7", 1, simple_board},
                       Case{"usb:SN-5", 0, "at 1-1: CyVerse USB 2.0 SH4, rotary switch 3"},
                       Case{"usb:9", 2, "at 1-3: CyVerse USB 2.0 SH4, rotary switch 9"}}) {
    const auto board = device(c.spec, false);
    ASSERT_EQ(opening(*board), "") << c.spec;
    EXPECT_EQ(board->description(), c.description);
    DeviceReading reading;
    ASSERT_EQ(board->exchange(all_volts(1), reading), LinkFault::kNone) << c.spec;
    for (size_t port = 0; port < 3; ++port)
      EXPECT_EQ(bus().port[port].at_rest(), port != c.port) << c.spec << " port " << port;
  }
  EXPECT_EQ(opening(*device("usb")),
            "usb: there are several boards, name one of usb:1-1 usb:1-3 usb:1-2");
  EXPECT_EQ(opening(*device("usb:4")),
            "usb:4: no board has the bus path, serial number or rotary switch 4; there are usb:1-1 "
            "(rotary switch 3) usb:1-3 (rotary switch 9) usb:1-2 (rotary switch 7)");
}

/// Of boards that are asked for their switch, one does not answer.
TEST_F(UsbBoards, ABoardThatDidNotOpenIsFree) {
  UsbPort& silent = plug(0, "sh4");
  plug(1, "sh4").inputs = 0x70;
  silent.fault = LinkFault::kTimeout;
  const auto seventh = device("usb:7", false);
  ASSERT_EQ(opening(*seventh), "");
  const auto first = device("usb:1-1", false), again = device("usb:1-1", false);
  expect_contains(opening(*first), "does not answer");
  silent.fault = LinkFault::kNone;
  EXPECT_EQ(opening(*again), "");
}

TEST_F(UsbBoards, OpenSaysWhatToDo) {
  const std::string absent = opening(*device());
  EXPECT_EQ(absent.find("usb: no CyVerse USB 2.0 SH4 (0cec:0205) or "), 0u) << absent;
  EXPECT_EQ(absent.substr(absent.size() - 14), " is plugged in");
  UsbPort& port = plug(0, "sh4");
  port.forbidden = true;
  const std::string denied = opening(*device());
  expect_contains(denied, "/dev/bus/usb/001/");
  expect_contains(denied, "install the udev rule 70-spidar.rules");
  port.forbidden = false;
  const auto first = device();
  ASSERT_EQ(opening(*first), "");
  const std::string busy = opening(*device());
  expect_contains(busy, "another program uses it");
}

TEST_F(UsbBoards, AKernelDriverIsDetached) {
  plug(0, "sh4").has_driver = true;
  const auto board = device();
  EXPECT_EQ(opening(*board), "");
}

TEST_P(EachUsbBoard, EveryFaultIsNamedAndPasses) {
  UsbPort& port = plug(0, GetParam());
  const auto board = only_device(false);
  ASSERT_EQ(opening(*board), "");
  std::vector<LinkFault> faults{LinkFault::kTimeout, LinkFault::kStall, LinkFault::kShort,
                                LinkFault::kBabble, LinkFault::kBusError};
  if (GetParam() == "sh4") faults.push_back(LinkFault::kWrongEcho);
  DeviceReading reading;
  for (const LinkFault fault : faults) {
    const uint64_t halts = port.halts_cleared;
    port.fault = fault;
    // Of three in a row, so that the board is reset as well.
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(board->exchange(all_volts(1), reading), fault);
    }
    EXPECT_EQ(board->health().count(fault), 3u) << to_string(fault);
    EXPECT_EQ(board->health().last_fault, fault);
    EXPECT_GT(port.halts_cleared, halts) << to_string(fault);
    port.fault = LinkFault::kNone;
    // A reply that was under way when the fault ended may still be in the board.
    int tries = 0;
    while (board->exchange(all_volts(1), reading) != LinkFault::kNone) ASSERT_LT(++tries, 3);
  }
  EXPECT_GT(board->health().round_trip_median_ns, 0);
}

TEST_P(EachUsbBoard, UnpluggedAndBackAgain) {
  for (const int first : {0, EPROTO}) {
    plug(1, GetParam());
    const auto board = only_device(true);
    ASSERT_EQ(opening(*board), "");
    DeviceReading reading;
    exchange_until(*board, LinkFault::kNone, reading);
    // In flight for as long as the board says nothing.
    bus().port[1].fault = LinkFault::kTimeout;
    exchange_until(*board, LinkFault::kTimeout, reading);
    unplug(1, first);
    exchange_until(*board, LinkFault::kGone, reading);
    EXPECT_GE(board->health().count(LinkFault::kGone), 1u);
    expect_contains(opening(*board), "at 1-2 is not plugged in");

    UsbPort& again = plug(1, GetParam());
    again.count[0] = 12;
    ASSERT_EQ(opening(*board), "");
    EXPECT_TRUE(again.at_rest());
    exchange_until(*board, LinkFault::kNone, reading);
    EXPECT_EQ(reading.count[0], 12);
    board->close();
    EXPECT_TRUE(again.at_rest());
    clear_bus();
  }
}

TEST_F(UsbBoards, CountsOfACalibratedProfileAreTheBoards) {
  UsbPort& port = plug(0, "sh4");
  port.count[0] = 600;
  Profile calibrated = profile;
  for (const bool offsets : {false, true}) {
    calibrated.drives[4].home_offset_m = offsets ? 0.01 : 0;
    const auto board = make_device("usb", calibrated, unguarded(false));
    board->open();
    DeviceReading reading;
    ASSERT_EQ(board->exchange({}, reading), LinkFault::kNone);
    EXPECT_EQ(reading.count[0], offsets ? 600 : 0);
  }
}

TEST_F(UsbBoards, MouseIsToldFromOtherDevicesOfItsId) {
  UsbPort& other = plug(0, "mouse");
  other.fault = LinkFault::kTimeout;  // does not answer to the question for its state
  const auto mouse = make_grip("mouse", profile, unguarded(false));
  const std::string what = opening(*mouse);
  expect_contains(what, "is no SPIDAR-mouse");
  EXPECT_EQ(other.updates, 0u);
  UsbPort& right = plug(1, "mouse");
  ASSERT_EQ(opening(*mouse), "");
  EXPECT_EQ(mouse->description(), "at 1-2: SPIDAR-mouse");
  for (int i = 0; i < 4; ++i) ASSERT_EQ(mouse->exchange(told(1)), LinkFault::kNone);
  EXPECT_FALSE(right.at_rest());
  EXPECT_TRUE(other.at_rest());
  mouse->close();
  EXPECT_TRUE(right.at_rest());
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The software centre of a desktop finds the package by the modalias.
TEST(UsbKinds, EachHasAUdevRuleAndAModalias) {
  const std::string rules = text_of(UDEV_RULES), metainfo = text_of(METAINFO);
  for (const DeviceKind& kind : devices()) {
    if (kind.usb.vendor == 0) continue;
    const std::string id = kind.usb.text();
    const std::string rule = "ATTR{idVendor}==\"" + id.substr(0, 4) + "\", ATTR{idProduct}==\"" +
                             id.substr(5) + "\", TAG+=\"uaccess\"";
    EXPECT_NE(rules.find(rule), std::string::npos) << kind.title << ": no line with " << rule;
    std::array<char, 24> alias{};
    std::snprintf(alias.data(), alias.size(), "usb:v%04Xp%04Xd*", kind.usb.vendor,
                  kind.usb.product);
    EXPECT_NE(metainfo.find(alias.data()), std::string::npos) << kind.title << ": " << alias.data();
  }
}

}  // namespace
}  // namespace spidar::test::usb_boards_test
