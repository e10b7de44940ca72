// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A single board, and the code around boards: the device that waits for the link, the factory, and
// the simulated device behind a board's packets.
#include <condition_variable>
#include <mutex>

#include "examples/example_board.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "tests/spidar/board_bench.h"
#include "tests/spidar/device_test.h"
#include "tests/support/test.h"

namespace spidar::test::board_device_test {
namespace {

TEST(Uart, ReportsTooFewMotors) {
  BoardBench bench("uart");
  std::vector<std::unique_ptr<Transport>> lines;
  lines.push_back(bench.transport_to(std::make_unique<emulated::Uart>(
      bench.recorded, std::vector<emulated::Uart::Station>{{2, {5, 1, 4, 4, 0, 0}}})));
  boards::Uart board("uart:/dev/x", bench.profile, std::move(lines));
  expect_contains(opening(board),
                  "1 motor boards answer, with 4 motors; the profile has 8 strings");
}

TEST(EncoderCounts, AllowWhatAHandCanSinceTheLastReading) {
  constexpr int64_t kMs = 1'000'000;
  int64_t now_ns = 5 * kMs;
  boards::EncoderCounts counts(16);
  counts.open({5000}, 1);
  EXPECT_TRUE(counts.update({5000}, now_ns));
  EXPECT_TRUE(counts.update({5000 + 4096}, now_ns += kMs));
  EXPECT_FALSE(counts.update({9096 + 4096}, now_ns += kMs - 1));  // 2048 within a millisecond
  // The counters began anew: that does not pass by waiting for it.
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(counts.update({0}, now_ns += kMs));
  EXPECT_EQ(counts.counts()[0], 9096);
  // After a break of many milliseconds a quarter of the range, after a longer one no more.
  EXPECT_FALSE(counts.update({9096 + 16385}, now_ns += 100 * kMs));
  EXPECT_TRUE(counts.update({9096 + 16384}, now_ns += 7 * kMs));
}

/// Bit 11 is 2048 counts, as far as a hand gets in a millisecond.
TEST(EncoderCounts, ComeBackFromABitThatFlipped) {
  int64_t now_ns = 0;
  const auto next_ns = [&] { return now_ns += 1'000'000; };
  boards::EncoderCounts counts(16);
  counts.open({5000, 7000}, 2);
  EXPECT_TRUE(counts.update({5000, 7000}, next_ns()));
  EXPECT_TRUE(counts.update({5000 + 2048, 7001}, next_ns()));
  EXPECT_TRUE(counts.update({4999, 7002}, next_ns()));
  EXPECT_EQ(counts.counts()[0], 4999);
  EXPECT_EQ(counts.counts()[1], 7002);
}

/// The example of docs/extend.md.
TEST(ExampleBoard, IsABoard) {
  const DeviceKind kind = example_kinds().front();
  BoardBench bench("sh4");
  boards::StringLink device(
      std::get<std::unique_ptr<boards::Board>>(
          kind.attach("example", bench.profile, bench.transport_to(kind.emulate(bench.recorded)))),
      {boards::CountZero::kFirstOpen, false, false});
  *bench.wire = LinkFault::kTimeout;
  EXPECT_THROW(device.open(), DeviceError);
  *bench.wire = LinkFault::kNone;
  device.open();
  bench.motors.count[6] = -9;
  DeviceReading reading;
  ASSERT_EQ(device.exchange(all_volts(1), reading), LinkFault::kNone);
  EXPECT_EQ(bench.motors.digit[7], 415);
  EXPECT_EQ(reading.count[6], -9);
  device.close();
  EXPECT_TRUE(bench.motors.all_zero());
}

/// A wire that does not answer until it is told to.
class HeldTransport final : public Transport {
 public:
  explicit HeldTransport(std::unique_ptr<Transport> real) : real_(std::move(real)) {}
  void open() override { real_->open(); }
  Transfer transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t deadline_ns) noexcept override {
    std::unique_lock<std::mutex> lock(mutex_);
    free_.wait(lock, [this] { return !held_; });
    return real_->exchange(packets, reply, deadline_ns);
  }
  void recover() noexcept override { real_->recover(); }
  std::optional<LastWill> last_will() const override { return std::nullopt; }
  void close() noexcept override { real_->close(); }
  void hold(bool held) {
    const std::lock_guard<std::mutex> lock(mutex_);
    held_ = held;
    free_.notify_all();
  }

 private:
  const std::unique_ptr<Transport> real_;
  std::mutex mutex_;
  std::condition_variable free_;
  bool held_ = false;
};

TEST(StringLink, DoesNotWaitLongerThanItMayAndTakesLateReplies) {
  BoardBench bench("sh4");
  auto transport = std::make_unique<HeldTransport>(
      bench.transport_to(std::make_unique<emulated::Sh4>(bench.recorded)));
  HeldTransport& wire = *transport;
  boards::StringLink device(
      std::make_unique<boards::Sh4>("sh4", bench.profile, std::move(transport)), {});
  device.open();
  DeviceReading reading;
  wire.hold(true);
  EXPECT_EQ(device.exchange(all_volts(1), reading), LinkFault::kTimeout);
  EXPECT_EQ(device.exchange(all_volts(1), reading), LinkFault::kTimeout);
  // Three requests are one under way and two that wait; a fourth has no room.
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(device.exchange(all_volts(1), reading), LinkFault::kTimeout);
  bench.motors.count[0] = 7;
  wire.hold(false);
  while (device.exchange(all_volts(1), reading) != LinkFault::kNone) {
  }
  EXPECT_EQ(reading.count[0], 7);
  EXPECT_GE(device.health().late_replies, 1u);
}

/// How one may be named without options.
std::vector<std::string> real_names(const DeviceKind& kind) {
  const std::string one = std::string(kind.device) + (kind.needs_rest() ? ":/dev/a" : ":1-2.3");
  if (kind.needs_rest()) return {one};
  return {kind.device, one};
}

/// Every name of a device with strings.
std::vector<std::pair<std::string, const DeviceKind*>> names_with_strings() {
  std::vector<std::pair<std::string, const DeviceKind*>> names;
  for (const std::string& board : boards_that_there_are(true)) {
    const DeviceKind& kind = kind_of(board);
    names.emplace_back("sim:" + board, &kind);
    for (const std::string& real : real_names(kind)) names.emplace_back(real, &kind);
  }
  return names;
}

/// The message of make_device(); empty on success.
std::string refusal_of(const std::string& spec, const Profile& profile) {
  return message_of<DeviceError>([&] { make_device(spec, profile); });
}

TEST(DeviceFactory, ListsKnownDevicesForUnknownNames) {
  const Profile profile = load_profile("spidar-g6x");
  std::vector<std::string> unknown{"foo", "", "sim:"};
  for (const DeviceKind& kind : devices())
    if (!kind.needs_rest()) unknown.push_back(std::string(kind.device) + ":");
  for (const std::string& spec : unknown) {
    const std::string what = message_of<DeviceError>([&] { make_grip(spec, profile); });
    EXPECT_EQ(what.find("unknown device \"" + spec + "\"; known are: sim, sim:BOARD, none, auto, " +
                        devices()[0].names),
              0u)
        << what;
    for (const DeviceKind& kind : devices()) expect_contains(what, std::string(", ") + kind.names);
  }
  for (const DeviceKind& kind : devices()) {
    const std::string spec = std::string("sim:") + kind.board;
    EXPECT_EQ(make_grip(spec, profile)->name(), spec);
    EXPECT_EQ(make_grip(spec, profile)->traits().has_strings, kind.has_strings()) << spec;
    for (const std::string& real : real_names(kind)) {
      EXPECT_EQ(make_grip(real, profile)->name(), real);
      EXPECT_EQ(make_grip(real, profile)->traits().has_strings, kind.has_strings()) << real;
      if (!kind.has_strings()) {
        EXPECT_THROW(make_device(real, profile), DeviceError) << real;
      }
    }
    if (!kind.has_strings()) {
      EXPECT_THROW(make_device(spec, profile), DeviceError) << spec;
    }
  }
  for (const std::string spec : {"uart:/dev/ttyUSB0,/dev/ttyUSB1", "inverse3:049D,port=8500",
                                 "sound:A,3=x,4=0.6/0.8/0,carrier=40,gain=50"}) {
    EXPECT_EQ(make_grip(spec, profile)->name(), spec);
  }
  EXPECT_THROW(make_grip("sim:x", profile), DeviceError);
  for (const char* spec : {"inverse3:,port=1", "inverse3:A,port=0", "inverse3:A,port=65536",
                           "inverse3:A,x=1", "inverse3:", "sound", "sound:", "sound:A,5=x"})
    EXPECT_THROW(make_grip(spec, profile), DeviceError) << spec;
  EXPECT_THROW(make_device("uart:/dev/a,", profile), DeviceError);
}

TEST(DeviceFactory, RefusesNegativeVoltsForBoardsWithoutThem) {
  const Profile profile = load_profile("spidar-g6x4");
  for (const auto& [spec, kind] : names_with_strings()) {
    const std::string error = refusal_of(spec, profile);
    EXPECT_EQ(error.find("negative volts for string 2") == std::string::npos, kind->traits.negative)
        << spec << ": " << error;
  }
}

/// A driver gets what it is to drive from the profile, but what the board is from its protocol.
TEST(DeviceFactory, RefusesProfilesOfBoardsThatThereAreNot) {
  const Profile fits = load_profile("spidar-g645");  // positive motors
  for (const auto& [spec, kind] : names_with_strings()) {
    Profile weak = fits;
    weak.dac_bits = kind->traits.dac_bits;
    for (StringDrive& drive : weak.drives) drive.max_tension_N = 3.3 * drive.newtons_per_volt;
    EXPECT_EQ(refusal_of(spec, weak), "");
    for (const int bits : {8, 11, 13, 16, 24}) {
      Profile other = weak;
      other.dac_bits = bits;
      EXPECT_NE(refusal_of(spec, other).find("has dac_bits = " + std::to_string(bits)),
                std::string::npos)
          << spec << ": " << refusal_of(spec, other);
    }
    Profile fine = weak;
    fine.drives[5].metres_per_count = 4.8e-6;
    EXPECT_NE(refusal_of(spec, fine).find("metres_per_count = 4.8e-06 for string 5"),
              std::string::npos)
        << spec << ": " << refusal_of(spec, fine);
    Profile strong = weak;
    strong.drives[4].max_tension_N = 3.4 * strong.drives[4].newtons_per_volt;
    EXPECT_EQ(refusal_of(spec, strong).find("wants 3.4 V for string 4 (max_tension_N)") !=
                  std::string::npos,
              kind->traits.max_V > 0 && kind->traits.max_V < 3.4)
        << spec << ": " << refusal_of(spec, strong);
  }
}

}  // namespace
}  // namespace spidar::test::board_device_test
