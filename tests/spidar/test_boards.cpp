// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Every kind of board with its emulation, without a wire.
#include <condition_variable>
#include <map>
#include <mutex>

#include "spidar/loop/string_grip.h"
#include "spidar/session/device_factory.h"
#include "spidar/session/haptic_session.h"
#include "tests/spidar/board_bench.h"
#include "tests/spidar/device_test.h"
#include "tests/support/test.h"

namespace spidar::test::boards_test {
namespace {

class Boards : public testing::TestWithParam<std::string>, public BoardBench {
 protected:
  Boards() : BoardBench(GetParam()) {}
};
INSTANTIATE_TEST_SUITE_P(, Boards, testing::ValuesIn(boards_that_there_are(true)), name_of);

TEST_P(Boards, OpenLeavesTheMotorsAtZero) {
  motors.digit[2] = 77;  // of an earlier host
  const auto device = this->device();
  device->open();
  EXPECT_TRUE(motors.all_zero());
  EXPECT_GE(motors.updates, 1);
  for (const int digit : motors.history) EXPECT_EQ(digit, 0);
}

TEST_P(Boards, VoltsBecomeDigitsAndCountsComeBack) {
  motors.inputs = 0x00A3;
  const auto device = this->device();
  device->open();
  for (size_t i = 0; i < kMaxStrings; ++i) motors.count[i] = 100 * static_cast<int>(i) - 350;
  MotorVolts volts;
  for (size_t i = 0; i < kMaxStrings; ++i) volts.volt[i] = 0.25 * static_cast<double>(i);
  DeviceReading reading;
  ASSERT_EQ(device->exchange(volts, reading), LinkFault::kNone);
  // 415 digits per volt nominally (4095 at 9.867 V); 4096 at 3.3 V on the UART boards.
  const double per_V = is_uart ? 4096 / 3.3 : 4095 / profile.dac_max_V;
  for (size_t i = 0; i < kMaxStrings; ++i) {
    EXPECT_EQ(motors.digit[i], static_cast<int>(std::lround(per_V * volts.volt[i]))) << i;
    EXPECT_EQ(reading.count[i], 100 * static_cast<int>(i) - 350) << i;
  }
  const bool has_inputs = device->description().find("rotary switch 10") != std::string::npos;
  EXPECT_EQ(reading.inputs, has_inputs ? 0xA3u : 0u);
}

TEST_P(Boards, VoltsBeyondTheConverterAreCut) {
  const auto device = this->device();
  device->open();
  MotorVolts volts = all_volts(1);
  volts.volt[0] = 1e9;
  volts.volt[1] = -1e9;
  volts.volt[2] = std::numeric_limits<double>::quiet_NaN();
  volts.volt[3] = std::numeric_limits<double>::infinity();
  DeviceReading reading;
  ASSERT_EQ(device->exchange(volts, reading), LinkFault::kNone);
  EXPECT_EQ(motors.digit[0], 4095);
  EXPECT_EQ(motors.digit[1], kind.traits.negative ? -4095 : 0);
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
  ASSERT_GE(motors.history.size(), before + boards::StringLink::kRamp_ms);
  const int full = motors.history[before - 1];
  for (size_t i = before; i < motors.history.size(); ++i) {
    // A twentieth a step, and half a digit of rounding at both ends.
    EXPECT_LE(motors.history[i - 1] - motors.history[i], full / boards::StringLink::kRamp_ms + 1)
        << i;
    EXPECT_LE(motors.history[i], motors.history[i - 1]) << i;
  }
  const int updates = motors.updates;
  device->close();
  EXPECT_EQ(motors.updates, updates);
  EXPECT_EQ(device->exchange(all_volts(1), reading), LinkFault::kGone);
}

TEST_P(Boards, GarbageIsNotTakenForCounts) {
  const auto device = this->device();
  device->open();
  *wire = LinkFault::kWrongReply;
  DeviceReading reading;
  reading.count.fill(42);
  const LinkFault fault = device->exchange(all_volts(1), reading);
  EXPECT_EQ(reading.count[0], 42);
  // Which check finds it depends on what the packets repeat: the D/A, or else a header, or nothing.
  const std::map<std::string, LinkFault> finds{{"sh4", LinkFault::kWrongEcho},
                                               {"uart", LinkFault::kWrongReply},
                                               {"simple", LinkFault::kCounterJump}};
  if (const auto found = finds.find(GetParam()); found != finds.end()) {
    EXPECT_EQ(fault, found->second) << to_string(fault);
  } else {
    EXPECT_TRUE(fault == LinkFault::kWrongReply || fault == LinkFault::kCounterJump)
        << to_string(fault);
  }
  EXPECT_EQ(device->health().last_fault, fault);
}

TEST_P(Boards, CountsGoOnOverWrapsAndJumpsAreRefused) {
  motors.count[0] = 32000;
  motors.count[1] = -32000;
  const auto device = this->device();
  device->open();
  DeviceReading reading;
  for (int i = 1; i <= 100; ++i) {
    motors.count[0] = 32000 + 1000 * i;
    motors.count[1] = -32000 - 1000 * i;
    ASSERT_EQ(device->exchange({}, reading), LinkFault::kNone);
    ASSERT_EQ(reading.count[0], 1000 * i);
    ASSERT_EQ(reading.count[1], -1000 * i);
  }
  motors.count[0] += 20000;
  EXPECT_EQ(device->exchange({}, reading), LinkFault::kCounterJump);
  EXPECT_EQ(device->health().last_fault, LinkFault::kCounterJump);
  EXPECT_EQ(reading.count[0], 100000);
  motors.count[0] -= 20000;
  EXPECT_EQ(device->exchange({}, reading), LinkFault::kNone);
}

TEST_P(Boards, CountsAreZeroedByPolicyOnly) {
  struct Case {
    boards::CountZero policy;
    int32_t first, again;
  };
  for (const Case c :
       {Case{boards::CountZero::kFirstOpen, 0, 50}, Case{boards::CountZero::kNever, 500, 550}}) {
    motors.count[3] = 500;
    const auto device = this->device(false, c.policy);
    DeviceReading reading;
    device->open();
    ASSERT_EQ(device->exchange({}, reading), LinkFault::kNone);
    EXPECT_EQ(reading.count[3], c.first);
    *wire = LinkFault::kGone;
    EXPECT_EQ(device->exchange({}, reading), LinkFault::kGone);
    EXPECT_THROW(device->open(), DeviceError);
    motors.count[3] = 550;  // moved meanwhile
    *wire = LinkFault::kNone;
    device->open();
    ASSERT_EQ(device->exchange({}, reading), LinkFault::kNone);
    EXPECT_EQ(reading.count[3], c.again);
  }
}

TEST_P(Boards, ABoardThatWasWithoutPowerIsNotTakenBack) {
  for (const boards::CountZero policy :
       {boards::CountZero::kFirstOpen, boards::CountZero::kNever}) {
    motors.count[3] = 5000;
    const auto device = this->device(false, policy);
    DeviceReading reading;
    device->open();
    *wire = LinkFault::kGone;
    EXPECT_EQ(device->exchange({}, reading), LinkFault::kGone);
    *wire = LinkFault::kNone;
    // It began anew, and a hand moves the grip from there: also when the counters look right again.
    for (const int32_t count : {3, 1500, 5100}) {
      motors.count[3] = count;
      expect_contains(opening(*device), "was without power");
    }
    EXPECT_EQ(device->health().last_fault, LinkFault::kCounterJump);
    const auto anew = this->device(false, policy);
    anew->open();
    ASSERT_EQ(anew->exchange({}, reading), LinkFault::kNone);
    EXPECT_EQ(reading.count[3], policy == boards::CountZero::kNever ? 5100 : 0);
  }
}

/// Nearer to where they were than to zero, with or without a jump from there.
TEST_P(Boards, ABoardThatHadItsPowerIsTakenBack) {
  for (const int32_t count : {5000, 5100, 2600}) {
    motors.count[3] = 5000;
    const auto device = this->device(false);
    device->open();
    DeviceReading reading;
    *wire = LinkFault::kGone;
    EXPECT_EQ(device->exchange({}, reading), LinkFault::kGone);
    *wire = LinkFault::kNone;
    motors.count[3] = count;
    device->open();
    ASSERT_EQ(device->exchange({}, reading), LinkFault::kNone);
    EXPECT_EQ(reading.count[3], count - 5000);
  }
}

}  // namespace
}  // namespace spidar::test::boards_test
