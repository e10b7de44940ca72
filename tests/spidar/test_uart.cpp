// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// UART boards over pseudo-terminals.
#include "spidar/devices/uart/board.h"
#include "spidar/link/emulated_transport.h"
#include "spidar/link/link_thread.h"
#include "spidar/session/device_factory.h"
#include "spidar/transports/tty_transport.h"
#include "tests/spidar/board_bench.h"
#include "tests/spidar/device_test.h"
#include "tests/support/pseudo_terminal.h"
#include "tests/support/recorded_motors.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"

namespace spidar::test::uart_test {
namespace {

constexpr uart_motor::BoardInfo kB3M{5, 1, 4, 4, 0, 0};
constexpr uart_motor::BoardInfo kB5M{7, 1, 8, 0, 4, 0};

class UartLines : public testing::Test {
 protected:
  /// Guarded by nobody, and exchanging on this thread.
  std::unique_ptr<StringDevice> device(const std::string& spec) const {
    return make_device(spec, profile, unguarded());
  }

  // The line's thread is a scheduler away: a slow machine may miss deadlines, not answers.

  static void open(StringDevice& board) {
    for (;;) {
      try {
        return board.open();
      } catch (const DeviceError& error) {
        const bool may_be_late =
            error.code() == DeviceErrorCode::kAbsent || error.code() == DeviceErrorCode::kFailed;
        if (!may_be_late) throw;
      }
    }
  }

  static void exchange_until(StringDevice& board, double volt, LinkFault wanted,
                             DeviceReading& reading) {
    while (board.exchange(all_volts(volt), reading) != wanted) {
    }
  }

  /// The answer to an earlier command may have come late, too, in place of that to the last one.
  static void exchange_until_counted(StringDevice& board, double volt, size_t string, int count,
                                     DeviceReading& reading) {
    do {
      exchange_until(board, volt, LinkFault::kNone, reading);
    } while (reading.count[string] != count);
  }

  const Profile profile = load_profile("spidar-g6x5-r");
  MotorBench first, second;
  std::shared_ptr<RecordedMotors> first_motors = std::make_shared<RecordedMotors>(first),
                                  second_motors = std::make_shared<RecordedMotors>(second);
};

TEST_F(UartLines, OneBoardOfEightMotors) {
  UartLine line({first_motors, {{4, kB5M}}});
  const auto board = device("uart:" + line.path());
  open(*board);
  EXPECT_TRUE(first.all_zero());
  DeviceReading reading;
  for (int i = 1; i <= 100; ++i) {
    first.count[7] = 500 * i;
    exchange_until_counted(*board, -1.0, 7, 500 * i, reading);
  }
  // Bit for bit: −1 V is −1241.2 digits.
  EXPECT_EQ(first.digit[0], -1241);
}

TEST_F(UartLines, AskedForTwiceInOneProcess) {
  UartLine line({first_motors, {{4, kB5M}}});
  const auto board = device("uart:" + line.path());
  open(*board);
  const auto again = device("uart:" + line.path());
  const std::string text = opening(*again);
  expect_contains(text, line.path());
  expect_contains(text, "another element of this one");
  board->close();
  open(*again);
}

TEST_F(UartLines, TwoBoardsOnOneLineAndOnTwo) {
  for (const bool two_lines : {false, true}) {
    std::vector<emulated::Uart::Station> stations{{1, kB3M}};
    std::optional<UartLine> other;
    if (two_lines) {
      other.emplace(emulated::Uart(second_motors, {{1, kB3M}}));
    } else {
      stations.push_back({6, kB3M});
    }
    UartLine line({first_motors, stations});
    const auto board =
        device("uart:" + line.path() + (two_lines ? "," + other->path() : std::string()));
    EXPECT_EQ(board->description(), "");
    open(*board);
    EXPECT_EQ(board->description(),
              "UART motor boards: number 1 of model 5 with 4 motors, number " +
                  std::to_string(two_lines ? 1 : 6) + " of model 5 with 4 motors");
    MotorBench& last = two_lines ? second : first;
    const size_t at = two_lines ? 1 : 5;  // motor 5 of all
    last.count[at] = 0;
    DeviceReading reading;
    exchange_until(*board, 0.5, LinkFault::kNone, reading);
    last.count[at] = -77;
    exchange_until_counted(*board, 0.5, 5, -77, reading);
    EXPECT_EQ(last.digit[at], static_cast<int>(std::lround(0.5 * 4096 / 3.3)));
  }
}

TEST_F(UartLines, SilenceIsATimeOutAndPasses) {
  UartLine line({first_motors, {{0, kB5M}}});
  const auto board = device("uart:" + line.path());
  open(*board);
  DeviceReading reading;
  line.set_silent(true);
  exchange_until(*board, 1, LinkFault::kTimeout, reading);
  EXPECT_GE(board->health().count(LinkFault::kTimeout), 1u);
  line.set_silent(false);
  exchange_until(*board, 1, LinkFault::kNone, reading);
}

TEST_F(UartLines, AHangUpIsAnUnplug) {
  std::optional<UartLine> line(std::in_place, emulated::Uart(first_motors, {{0, kB3M}}));
  // This one answers at once, so that each step of its ramp arrives.
  std::vector<std::unique_ptr<Transport>> lines;
  lines.push_back(std::make_unique<TtyTransport>("uart", line->path(), uart_motor::kBaud));
  lines.push_back(std::make_unique<emulated::Transport>(std::make_unique<emulated::Uart>(
      second_motors, std::vector<emulated::Uart::Station>{{0, kB3M}})));
  const auto board = std::make_unique<boards::StringLink>(
      std::make_unique<boards::Uart>("uart", profile, std::move(lines)), unguarded());
  open(*board);
  DeviceReading reading;
  exchange_until(*board, 1, LinkFault::kNone, reading);
  EXPECT_FALSE(second.all_zero());
  line.reset();
  exchange_until(*board, 1, LinkFault::kGone, reading);
  EXPECT_FALSE(second.all_zero());
  // The boards of the line that is left are taken down slowly.
  const int full = second.digit[0];
  board->close();
  EXPECT_TRUE(second.all_zero());
  const std::vector<int>& put_out = second.history;
  for (size_t i = 1; i < put_out.size(); ++i)
    EXPECT_LE(put_out[i - 1] - put_out[i], full / boards::StringLink::kRamp_ms + 1) << i;
}

TEST_F(UartLines, OpenSaysWhatIsWrong) {
  const auto says = [&](const std::string& spec) { return opening(*device(spec)); };
  EXPECT_EQ(says("uart:/nowhere/tty"),
            "uart:/nowhere/tty: cannot be opened: No such file or directory; serial lines have "
            "names such as /dev/ttyUSB0 and /dev/serial/by-id/…");
  expect_contains(says("uart:/dev/null"), "it is no serial line");
  UartLine line({first_motors, {}});
  expect_contains(says("uart:" + line.path()), "0 motor boards answer, with 0 motors");
}

TEST_F(UartLines, OnlyTheSameBoardsComeBack) {
  const TemporaryFolder folder;
  const std::filesystem::path link = folder.path / "line";
  const auto point_to = [&](const UartLine& line) {
    std::filesystem::remove(link);
    std::filesystem::create_symlink(line.path(), link);
  };
  UartLine line({first_motors, {{4, kB5M}}}), other({second_motors, {{4, kB5M}}});
  point_to(line);
  const auto board = device("uart:" + link.string());
  open(*board);
  board->close();
  point_to(other);
  expect_contains(message_of<DeviceError>([&] { open(*board); }), "is another device");
  EXPECT_EQ(second.updates, 0u);
  point_to(line);
  open(*board);
  board->close();
  // The adapter is the same, and what is connected to it is not.
  line.connect({second_motors, {{5, kB5M}}});
  expect_contains(message_of<DeviceError>([&] { open(*board); }), "these are other boards");
}

TEST(TtyList, AnAdapterIsKnownWhateverItsNumber) {
  const TemporaryFolder folder;
  namespace fs = std::filesystem;
  const auto plug_in = [&](const std::string& port, const std::string& serial, const char* tty) {
    const fs::path adapter = folder.path / "devices" / port;
    const fs::path device = adapter / (port + ":1.1") / tty;
    fs::create_directories(device / "tty" / tty);
    const auto put = [](const fs::path& file, const std::string& text) {
      std::ofstream(file) << text << "\n";
    };
    put(adapter / "idVendor", "0403");
    put(adapter / "idProduct", "6011");
    put(adapter / "product", "Quad\x1b[2J");
    if (!serial.empty()) put(adapter / "serial", serial);
    put(device.parent_path() / "bInterfaceNumber", "01");
    const fs::path entry = folder.path / "class" / "tty" / tty;
    fs::create_directories(entry);
    fs::create_directory_symlink(device, entry / "device");
    return tty_identity(std::string("/dev/") + tty, folder.path);
  };
  const DeviceIdentity first = plug_in("1-2", "A", "ttyUSB7"),
                       moved = plug_in("1-3", "A", "ttyUSB8"),
                       other = plug_in("1-4", "B", "ttyUSB9");
  EXPECT_EQ(first.text(), "Quad?[2J (0403:6011) interface 01, serial number A");
  EXPECT_TRUE(first.is_certainly(moved));
  EXPECT_FALSE(first.is_certainly(other));
  const DeviceIdentity here = plug_in("1-5", "", "ttyUSB10"),
                       there = plug_in("1-6", "", "ttyUSB11");
  EXPECT_TRUE(here.is_certainly(tty_identity("/dev/ttyUSB10", folder.path)));
  EXPECT_FALSE(here.is_certainly(there));
}

TEST(TtyList, ListsAdaptersAndNamedLines) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.path;
  for (const char* name : {"ttyUSB1", "ttyS0", "spidar0", "ttyACM0", "null"})
    std::ofstream(folder + "/" + name) << "";
  const std::vector<TtyLine> lines = list_tty_lines(folder);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].path, folder + "/spidar0");
  EXPECT_TRUE(lines[0].named);
  EXPECT_EQ(lines[1].path, folder + "/ttyACM0");
  EXPECT_FALSE(lines[1].named);
  EXPECT_EQ(lines[2].path, folder + "/ttyUSB1");
  EXPECT_TRUE(list_tty_lines("/nowhere").empty());
}

}  // namespace
}  // namespace spidar::test::uart_test
