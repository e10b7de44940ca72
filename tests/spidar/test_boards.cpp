/// Every kind of board against its emulation, without a wire.
#include <cmath>
#include <condition_variable>
#include <limits>
#include <mutex>

#include <gtest/gtest.h>

#include "examples/example_board.h"
#include "spidar/device_factory.h"
#include "spidar/emulation/wire_simulation.h"
#include "spidar/haptic_session.h"
#include "spidar/loop/grip_watch.h"
#include "tests/spidar/board_bench.h"

namespace spidar::test {
namespace {

void tick_until_running(HapticSession& session) {
  int64_t now_ns = 0;
  while (session.loop().snapshot().last.device != DeviceState::kRunning) {
    now_ns += kTick_ns;
    session.loop().tick(now_ns, now_ns);
  }
}

class Boards : public testing::TestWithParam<Kind>, public BoardBench {
 protected:
  Boards() : BoardBench(GetParam()) {}
};
const auto kNameOf = [](const testing::TestParamInfo<Kind>& kind) { return name_of(kind.param); };
INSTANTIATE_TEST_SUITE_P(, Boards,
                         testing::Values(Kind::kSh4, Kind::kSimple, Kind::kUart, Kind::kMouse,
                                         Kind::kForceFeedback),
                         kNameOf);

/// All but the mouse and the joystick, which have a force instead of motors and no encoders.
class BoardsThatCount : public Boards {};
INSTANTIATE_TEST_SUITE_P(, BoardsThatCount, testing::Values(Kind::kSh4, Kind::kSimple, Kind::kUart),
                         kNameOf);

TEST_P(Boards, OpenLeavesTheMotorsAtZero) {
  motors.digit[2] = 77;  // of an earlier host
  const auto device = this->device();
  device->open();
  if (counts()) {
    EXPECT_TRUE(motors.all_zero());
    EXPECT_GE(motors.updates, 1);
  }
  for (const int digit : motors.history) EXPECT_EQ(digit, 0);
}

TEST_P(BoardsThatCount, VoltsBecomeDigitsAndCountsComeBack) {
  motors.inputs = 0x00A3;
  const auto device = this->device();
  device->open();
  for (size_t i = 0; i < kMaxStrings; ++i) motors.count[i] = 100 * static_cast<int>(i) - 350;
  MotorVolts volts;
  for (size_t i = 0; i < kMaxStrings; ++i) volts.volt[i] = 0.25 * static_cast<double>(i);
  DeviceReading reading;
  ASSERT_EQ(device->exchange(volts, reading), ExchangeStatus::kOk);
  // 415 digits per volt nominally (4095 at 9.867 V); 4096 at 3.3 V on the UART boards.
  const double per_V = kind == Kind::kUart ? 4096 / 3.3 : 4095 / 9.867;
  for (size_t i = 0; i < kMaxStrings; ++i) {
    EXPECT_EQ(motors.digit[i], static_cast<int>(std::lround(per_V * volts.volt[i]))) << i;
    EXPECT_EQ(reading.count[i], 100 * static_cast<int>(i) - 350) << i;
  }
  EXPECT_EQ(reading.inputs, kind == Kind::kUart ? 0u : 0xA3u);
}

TEST_P(BoardsThatCount, VoltsBeyondTheConverterAreCut) {
  const auto device = this->device();
  device->open();
  MotorVolts volts = all_volts(1);
  volts.volt[0] = 1e9;
  volts.volt[1] = -1e9;
  volts.volt[2] = std::numeric_limits<double>::quiet_NaN();
  volts.volt[3] = std::numeric_limits<double>::infinity();
  DeviceReading reading;
  ASSERT_EQ(device->exchange(volts, reading), ExchangeStatus::kOk);
  EXPECT_EQ(motors.digit[0], 4095);
  EXPECT_EQ(motors.digit[1], kind == Kind::kUart ? -4095 : 0);
  EXPECT_EQ(motors.digit[2], 0);
  EXPECT_EQ(motors.digit[3], 0);
}

TEST_P(Boards, CloseRampsToZero) {
  const auto device = this->device();
  device->open();
  DeviceReading reading;
  for (int i = 0; i < 8; ++i) device->exchange(all_volts(2), reading);
  const size_t before = motors.history.size();
  device->close();
  ASSERT_GT(motors.history.size(), before);
  EXPECT_TRUE(motors.all_zero());
  if (!counts()) return;
  ASSERT_GE(motors.history.size(), before + BoardDevice::kRamp_ms);
  const int full = motors.history[before - 1];
  for (size_t i = before; i < motors.history.size(); ++i) {
    // A twentieth a step, and half a digit of rounding at both ends.
    EXPECT_LE(motors.history[i - 1] - motors.history[i], full / BoardDevice::kRamp_ms + 1) << i;
    EXPECT_LE(motors.history[i], motors.history[i - 1]) << i;
  }
  const int updates = motors.updates;
  device->close();
  EXPECT_EQ(motors.updates, updates);
  EXPECT_EQ(device->exchange(all_volts(1), reading), ExchangeStatus::kLost);
}

TEST_P(Boards, DestructionRampsToZeroToo) {
  {
    const auto device = this->device(true);
    device->open();
    DeviceReading reading;
    for (int i = 0; i < 8; ++i) device->exchange(all_volts(2), reading);
  }
  EXPECT_TRUE(motors.all_zero());
}

TEST_P(Boards, EveryFaultIsNamedCountedAndForgotten) {
  const auto device = this->device();
  device->open();
  const auto exchange = [&] {
    DeviceReading reading;
    ExchangeStatus worst = ExchangeStatus::kOk;
    for (int i = 0; i < cycles(); ++i) {
      const ExchangeStatus status = device->exchange(all_volts(1), reading);
      if (status != ExchangeStatus::kOk) worst = status;
    }
    return worst;
  };
  const LinkFault of_sending[] = {LinkFault::kStall, LinkFault::kGone};
  const LinkFault of_replies[] = {LinkFault::kTimeout, LinkFault::kShort, LinkFault::kBabble,
                                  LinkFault::kBusError};
  std::vector<LinkFault> faults(std::begin(of_sending), std::end(of_sending));
  if (counts()) faults.insert(faults.begin(), std::begin(of_replies), std::end(of_replies));
  for (const LinkFault fault : faults) {
    wire->fault = fault;
    const uint64_t before = device->health().count(fault);
    const ExchangeStatus expected = fault == LinkFault::kTimeout ? ExchangeStatus::kTimeout
                                    : fault == LinkFault::kGone  ? ExchangeStatus::kLost
                                                                 : ExchangeStatus::kBadReply;
    EXPECT_EQ(exchange(), expected) << to_string(fault);
    EXPECT_EQ(device->health().count(fault), before + 1) << to_string(fault);
    EXPECT_EQ(device->health().last_fault, fault);
    wire->fault = LinkFault::kNone;
    if (fault == LinkFault::kGone) device->open();
    EXPECT_EQ(exchange(), ExchangeStatus::kOk) << "after " << to_string(fault);
  }
}

TEST_P(BoardsThatCount, GarbageIsNotTakenForCounts) {
  const auto device = this->device();
  device->open();
  wire->fault = LinkFault::kWrongReply;
  DeviceReading reading;
  reading.count.fill(42);
  EXPECT_EQ(device->exchange(all_volts(1), reading), ExchangeStatus::kBadReply);
  EXPECT_EQ(reading.count[0], 42);
  // Which check finds it depends on what the packets repeat: the D/A, a header, or nothing.
  const LinkFault expected = kind == Kind::kSh4    ? LinkFault::kWrongEcho
                             : kind == Kind::kUart ? LinkFault::kWrongReply
                                                   : LinkFault::kCounterJump;
  EXPECT_EQ(device->health().last_fault, expected);
}

TEST_P(BoardsThatCount, CountsGoOnOverWrapsAndJumpsAreRefused) {
  motors.count[0] = 32000;
  motors.count[1] = -32000;
  const auto device = this->device();
  device->open();
  DeviceReading reading;
  for (int i = 1; i <= 100; ++i) {
    motors.count[0] = 32000 + 1000 * i;
    motors.count[1] = -32000 - 1000 * i;
    ASSERT_EQ(device->exchange({}, reading), ExchangeStatus::kOk);
    ASSERT_EQ(reading.count[0], 1000 * i);
    ASSERT_EQ(reading.count[1], -1000 * i);
  }
  motors.count[0] += 20000;
  EXPECT_EQ(device->exchange({}, reading), ExchangeStatus::kBadReply);
  EXPECT_EQ(device->health().last_fault, LinkFault::kCounterJump);
  EXPECT_EQ(reading.count[0], 100000);
  motors.count[0] -= 20000;
  EXPECT_EQ(device->exchange({}, reading), ExchangeStatus::kOk);
}

TEST_P(BoardsThatCount, CountsAreZeroedByPolicyOnly) {
  struct Case {
    CountZero policy;
    int32_t first, again;
  };
  for (const Case c : {Case{CountZero::kFirstOpen, 0, 50}, Case{CountZero::kEveryOpen, 0, 0},
                       Case{CountZero::kNever, 500, 550}}) {
    motors.count[3] = 500;
    const auto device = this->device(false, c.policy);
    DeviceReading reading;
    device->open();
    ASSERT_EQ(device->exchange({}, reading), ExchangeStatus::kOk);
    EXPECT_EQ(reading.count[3], c.first);
    wire->fault = LinkFault::kGone;
    EXPECT_EQ(device->exchange({}, reading), ExchangeStatus::kLost);
    EXPECT_THROW(device->open(), DeviceError);
    motors.count[3] = 550;  // moved meanwhile
    wire->fault = LinkFault::kNone;
    device->open();
    ASSERT_EQ(device->exchange({}, reading), ExchangeStatus::kOk);
    EXPECT_EQ(reading.count[3], c.again);
  }
}

TEST_P(BoardsThatCount, ABoardThatWasWithoutPowerIsNotTakenBack) {
  for (const CountZero policy : {CountZero::kFirstOpen, CountZero::kNever, CountZero::kEveryOpen}) {
    motors.count[3] = 5000;
    const auto device = this->device(false, policy);
    DeviceReading reading;
    device->open();
    wire->fault = LinkFault::kGone;
    EXPECT_EQ(device->exchange({}, reading), ExchangeStatus::kLost);
    wire->fault = LinkFault::kNone;
    motors.count[3] = 3;  // began anew
    if (policy == CountZero::kEveryOpen) {
      device->open();
      ASSERT_EQ(device->exchange({}, reading), ExchangeStatus::kOk);
      EXPECT_EQ(reading.count[3], 0);
      continue;
    }
    for (int attempt = 0; attempt < 2; ++attempt) {
      try {
        device->open();
        FAIL();
      } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("was without power"), std::string::npos);
      }
    }
    EXPECT_EQ(device->health().last_fault, LinkFault::kCounterJump);
    // Had it its power after all, nothing is lost.
    motors.count[3] = 5100;
    device->open();
    ASSERT_EQ(device->exchange({}, reading), ExchangeStatus::kOk);
    EXPECT_EQ(reading.count[3], policy == CountZero::kNever ? 5100 : 100);
  }
}

TEST_P(Boards, OpenSaysWhatIsWrong) {
  const auto device = this->device();
  for (const LinkFault fault : {LinkFault::kTimeout, LinkFault::kStall, LinkFault::kBabble}) {
    wire->fault = fault;
    try {
      device->open();
      FAIL() << to_string(fault);
    } catch (const DeviceError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find(name_of(kind)), 0u) << what;
      // UART boards that do not answer are no boards.
      const std::string expected = kind == Kind::kUart ? "0 motor boards" : to_string(fault);
      EXPECT_NE(what.find(expected), std::string::npos) << what;
    }
  }
  wire->fault = LinkFault::kNone;
  device->open();
}

TEST_P(Boards, TheHapticLoopDrivesIt) {
  SessionSettings by_hand;
  by_hand.threaded = false;
  HapticSession session(profile, this->device(), by_hand);
  EXPECT_TRUE(motors.all_zero());
  tick_until_running(session);
  EXPECT_EQ(session.loop().snapshot().counters.exchange_errors, 0u);
  if (counts()) {
    EXPECT_FALSE(motors.all_zero());
  }
}

/// Encoders that stand still although the force has changed are dead; a device without says nothing
/// by it.
TEST_P(Boards, ForceLastsWhereNothingIsCounted) {
  if (counts()) return;
  SessionSettings by_hand;
  by_hand.threaded = false;
  HapticSession session(profile, this->device(), by_hand);
  tick_until_running(session);
  int64_t now_ns = session.loop().snapshot().last.monotonic_ns;
  session.loop().set_playback_clock({now_ns, 0, 1.0, true});
  TimedWrench push;
  push.hold_ns = 3600 * kSecond_ns;
  push.wrench.force_N.x() = 1;
  ASSERT_TRUE(session.loop().schedule(push));
  const int64_t end_ns = now_ns + 4 * GripWatch::kFrozenAfter_ns;
  while (now_ns < end_ns) {
    now_ns += kTick_ns;
    session.loop().tick(now_ns, now_ns);
  }
  EXPECT_EQ(session.loop().snapshot().last.commanded.force_N.x(), 1);
  EXPECT_EQ(session.loop().snapshot().pose_trouble, PoseTrouble::kNone);
}

TEST(Mouse, PullsAsTheStringsWouldWithinItsLimit) {
  BoardBench bench(Kind::kMouse);
  const auto device = bench.device();
  device->open();
  const StructureMatrix W = structure_matrix(bench.profile.geometry, {});
  for (const double volt : {0.1, 5.0}) {
    MotorVolts volts;
    volts.volt[2] = volt;
    DeviceReading reading;
    for (int i = 0; i < 4; ++i) ASSERT_EQ(device->exchange(volts, reading), ExchangeStatus::kOk);
    Eigen::Vector2d force_N = W.col(2).head<2>() * volt * bench.profile.drives[2].newtons_per_volt;
    if (force_N.norm() > 1.5) force_N *= 1.5 / force_N.norm();
    // Rounded to millinewtons.
    EXPECT_NEAR(bench.motors.digit[0], 1000 * force_N.x(), 0.51);
    EXPECT_NEAR(bench.motors.digit[1], 1000 * force_N.y(), 0.51);
  }
}

TEST(Uart, TooFewMotorsAreSaid) {
  BoardBench bench(Kind::kUart);
  std::vector<std::unique_ptr<Transport>> lines;
  lines.push_back(bench.transport_to(std::make_unique<EmulatedUart>(
      bench.recorded, std::vector<EmulatedUart::Station>{{2, {5, 1, 4, 4, 0, 0}}})));
  UartBoard board("uart:/dev/x", bench.profile, std::move(lines));
  try {
    board.open();
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("1 motor boards answer, with 4 motors; the profile has "
                        "8 strings"),
              std::string::npos)
        << error.what();
  }
}

TEST(EncoderCounts, AllowWhatAHandCanSinceTheLastReading) {
  constexpr int64_t kMs = 1'000'000;
  int64_t now_ns = 5 * kMs;
  EncoderCounts counts(16);
  counts.open({5000}, 1);
  EXPECT_TRUE(counts.follow({5000}, now_ns));
  EXPECT_TRUE(counts.follow({5000 + 4096}, now_ns += kMs));
  EXPECT_FALSE(counts.follow({5000}, now_ns += kMs - 1));  // 2048 for less than a millisecond
  // The counters began anew: that does not pass by waiting for it.
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(counts.follow({0}, now_ns += kMs));
  EXPECT_EQ(counts.counts()[0], 9096);
  // After a break of many milliseconds a quarter of the range, after a longer one no more.
  EXPECT_FALSE(counts.follow({9096 + 16385}, now_ns += 100 * kMs));
  EXPECT_TRUE(counts.follow({9096 + 16384}, now_ns += 7 * kMs));
}

/// The other end of the example in docs/adding-a-board.md.
class EmulatedExample final : public EmulatedBoard {
 public:
  explicit EmulatedExample(EmulatedMotors& motors) : motors_(motors) {}
  void receive(ByteView bytes) noexcept override {
    std::array<int, kMaxStrings> digits{};
    for (size_t i = 0; i < digits.size(); ++i) digits[i] = bytes.u16(2 * i);
    motors_.put_out(digits);
    due_ = true;
  }
  size_t reply(MutableBytes bytes) noexcept override {
    if (!due_ || bytes.size < 16) return 0;
    due_ = false;
    for (size_t i = 0; i < kMaxStrings; ++i)
      bytes.put_u16(2 * i, static_cast<uint16_t>(motors_.counts()[i]));
    return 16;
  }

 private:
  EmulatedMotors& motors_;
  bool due_ = false;
};

TEST(ExampleBoard, IsABoard) {
  BoardBench bench(Kind::kSh4);
  BoardDevice device(std::make_unique<ExampleBoard>(
                         "example", bench.profile,
                         bench.transport_to(std::make_unique<EmulatedExample>(bench.recorded))),
                     {CountZero::kFirstOpen, false, false});
  device.open();
  bench.motors.count[6] = -9;
  DeviceReading reading;
  ASSERT_EQ(device.exchange(all_volts(1), reading), ExchangeStatus::kOk);
  EXPECT_EQ(bench.motors.digit[7], 415);
  EXPECT_EQ(reading.count[6], -9);
  device.close();
  EXPECT_TRUE(bench.motors.all_zero());
}

/// A wire that does not answer before it is told to.
class HeldTransport final : public Transport {
 public:
  explicit HeldTransport(std::unique_ptr<Transport> real) : real_(std::move(real)) {}
  void open() override { real_->open(); }
  Transfer exchange(std::initializer_list<ByteView> packets, MutableBytes reply,
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

TEST(BoardDevice, DoesNotWaitLongerThanItMayAndTakesLateReplies) {
  BoardBench bench(Kind::kSh4);
  auto transport = std::make_unique<HeldTransport>(
      bench.transport_to(std::make_unique<EmulatedSh4>(bench.recorded)));
  HeldTransport& wire = *transport;
  BoardDevice device(std::make_unique<Sh4Board>("sh4", bench.profile, std::move(transport)), {});
  device.open();
  DeviceReading reading;
  wire.hold(true);
  EXPECT_EQ(device.exchange(all_volts(1), reading), ExchangeStatus::kTimeout);
  EXPECT_EQ(device.exchange(all_volts(1), reading), ExchangeStatus::kTimeout);
  // Three requests are one under way and two that wait; a fourth has no room.
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(device.exchange(all_volts(1), reading), ExchangeStatus::kTimeout);
  bench.motors.count[0] = 7;
  wire.hold(false);
  while (device.exchange(all_volts(1), reading) != ExchangeStatus::kOk) {
  }
  EXPECT_EQ(reading.count[0], 7);
  EXPECT_GE(device.health().late_replies, 1u);
}

TEST(DeviceFactory, ListsWhatItKnowsForOtherNames) {
  const Profile profile = load_profile("spidar-g6x3-v2-r");
  for (const std::string spec : {"foo", "", "usb:", "sim:", "uart", "uart:", "mouse:", "ff:"}) {
    try {
      make_device(spec, profile);
      FAIL() << spec;
    } catch (const DeviceError& error) {
      EXPECT_EQ(error.what(), "unknown device \"" + spec +
                                  "\"; known are: sim, sim:BOARD, none, usb, usb:ID, uart:PATH, "
                                  "mouse, ff, ff:PATH");
    }
  }
  for (const std::string spec :
       {"usb", "usb:3", "usb:1-2.3", "uart:/dev/ttyUSB0,/dev/ttyUSB1", "mouse", "sim:sh4",
        "sim:simple", "sim:uart", "sim:mouse", "sim:ff", "ff", "ff:/dev/input/event3"}) {
    EXPECT_EQ(make_device(spec, profile)->name(), spec);
  }
  EXPECT_THROW(make_device("sim:x", profile), DeviceError);
  EXPECT_THROW(make_device("uart:/dev/a,", profile), DeviceError);
}

TEST(DeviceFactory, RefusesNegativeVoltsForBoardsWithoutThem) {
  const Profile profile = load_profile("spidar-g6x4");
  EXPECT_NO_THROW(make_device("sim:uart", profile));
  for (const char* spec : {"usb", "sim:sh4", "sim:simple"}) {
    try {
      make_device(spec, profile);
      FAIL() << spec;
    } catch (const DeviceError& error) {
      EXPECT_NE(std::string(error.what()).find("negative volts for string 2"), std::string::npos)
          << error.what();
    }
  }
}

/// The simulated grip feels the same whether volts are handed over or go through packets.
TEST(WireSimulation, HoldsTheGripWhereTheSimulationDoes) {
  for (const char* spec : {"sim", "sim:sh4", "sim:simple", "sim:uart"}) {
    const Profile profile = load_profile("spidar-g6x3-v2-r");
    SessionSettings by_hand;
    by_hand.threaded = false;
    HapticSession session(profile, make_device(spec, profile), by_hand);
    tick_until_running(session);
    const LoopSnapshot snapshot = session.loop().snapshot();
    EXPECT_EQ(snapshot.counters.exchange_errors, 0u) << spec;
    EXPECT_EQ(snapshot.counters.pose_errors, 0u) << spec;
    // All strings at rest pull alike, and the hand's spring of 300 N/m holds: within a newton's
    // way.
    EXPECT_LT(snapshot.last.pose.position_m.norm(), 1.0 / 300) << spec;
  }
}

}  // namespace
}  // namespace spidar::test
