// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Packets of the boards, written by hand from the published descriptions.
#include "spidar/devices/cyverse/packets.h"
#include "spidar/devices/force_feedback/packets.h"
#include "spidar/devices/mouse/packets.h"
#include "spidar/devices/uart/packets.h"
#include "spidar/guardian/guardian.h"
#include "tests/support/test.h"

namespace spidar::test::protocols_test {
namespace {

template <size_t N>
std::vector<uint8_t> bytes_of(const std::array<uint8_t, N>& packet) {
  return {packet.begin(), packet.end()};
}

/// `head`, then zeros up to `size`.
std::vector<uint8_t> padded(std::vector<uint8_t> head, size_t size) {
  head.resize(size, 0);
  return head;
}

ByteView view(const std::vector<uint8_t>& bytes) {
  return {bytes.data(), bytes.size()};
}

// --- SH4

const CyverseDigits kDigits{0, 1, 0x0123, 0x0FFF, 256, 255, 2048, 4000};
const std::vector<uint8_t> kDigitBytes{0x00, 0x00, 0x01, 0x00, 0x23, 0x01, 0xFF, 0x0F,
                                       0x00, 0x01, 0xFF, 0x00, 0x00, 0x08, 0xA0, 0x0F};

TEST(Sh4, UpdateIsOneFourteenThenDigits) {
  std::vector<uint8_t> expected{0x01, 0x0E};
  expected.insert(expected.end(), kDigitBytes.begin(), kDigitBytes.end());
  sh4::Packet packet;
  packet.fill(0xEE);
  sh4::encode_update(kDigits, packet);
  EXPECT_EQ(bytes_of(packet), padded(expected, 512));

  CyverseDigits digits{};
  ASSERT_TRUE(sh4::decode_update(packet, digits));
  EXPECT_EQ(digits, kDigits);
  packet[1] = 0x0D;
  EXPECT_FALSE(sh4::decode_update(packet, digits));
}

TEST(Sh4, ReadingHasEchoCountersAdcInputsInfo) {
  std::vector<uint8_t> bytes = kDigitBytes;
  const std::vector<uint8_t> rest{
      0x00, 0x80, 0xFF, 0xFF, 0x01, 0x00, 0x00, 0x01, 0, 0, 0, 0, 0, 0, 0x34, 0x12,  // counters
      0xFF, 0x0F, 0,    0,    0,    0,    0,    0,    0, 0, 0, 0, 0, 0, 0x01, 0x00,  // A/D
      0xA5, 0x80,                                                                    // inputs
      0x78, 0x56, 0x34, 0x12};                                                       // info
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  sh4::Reading reading;
  ASSERT_TRUE(sh4::decode_reading(view(padded(bytes, 512)), reading));
  EXPECT_EQ(reading.dac_echo, kDigits);
  EXPECT_EQ(reading.counter[0], 0x8000);
  EXPECT_EQ(reading.counter[1], 0xFFFF);
  EXPECT_EQ(reading.counter[3], 0x0100);
  EXPECT_EQ(reading.counter[7], 0x1234);
  EXPECT_EQ(reading.adc[0], 4095);
  EXPECT_EQ(reading.adc[7], 1);
  EXPECT_EQ(reading.inputs, 0x80A5);
  EXPECT_EQ(reading.rotary(), 0xA);
  EXPECT_EQ(reading.info, 0x12345678u);

  sh4::Packet packet;
  sh4::encode_reading(reading, packet);
  EXPECT_EQ(bytes_of(packet), padded(bytes, 512));
  EXPECT_FALSE(sh4::decode_reading(view(padded(bytes, 511)), reading));
  EXPECT_FALSE(sh4::decode_reading(view(padded(bytes, 513)), reading));
}

/// Whatever the driver computes: the upper bits of the board's twelve are not its own.
TEST(Sh4, DigitsBeyondTheDacAreClamped) {
  constexpr CyverseDigits kBeyond{4095, 4096, 5000, 0x1FFF, 0x8000, 0xFFFF, 0xF000, 7};
  constexpr CyverseDigits kClamped{4095, 4095, 4095, 4095, 4095, 4095, 4095, 7};
  sh4::Packet packet;
  sh4::encode_update(kBeyond, packet);
  CyverseDigits digits{};
  ASSERT_TRUE(sh4::decode_update(packet, digits));
  EXPECT_EQ(digits, kClamped);
  usb_simple::Packet simple;
  usb_simple::encode_set_dac(kBeyond, simple);
  ASSERT_EQ(usb_simple::decode_command(simple, digits), usb_simple::Command::kSetDac);
  EXPECT_EQ(digits, kClamped);
}

// --- Simple

TEST(UsbSimple, CommandsAreThoseOfTheFactSheet) {
  usb_simple::Packet packet;
  CyverseDigits digits{};
  usb_simple::encode_encoder_direction(0xFF, packet);
  EXPECT_EQ(bytes_of(packet), padded({0xA2, 0x1A, 0xFF}, 32));
  EXPECT_EQ(usb_simple::decode_command(packet, digits), usb_simple::Command::kEncoderDirection);

  std::vector<uint8_t> set_dac{0x52};
  set_dac.insert(set_dac.end(), kDigitBytes.begin(), kDigitBytes.end());
  usb_simple::encode_set_dac(kDigits, packet);
  EXPECT_EQ(bytes_of(packet), padded(set_dac, 32));
  EXPECT_EQ(usb_simple::decode_command(packet, digits), usb_simple::Command::kSetDac);
  EXPECT_EQ(digits, kDigits);

  usb_simple::encode_latch(packet);
  EXPECT_EQ(bytes_of(packet), padded({0x51}, 32));
  EXPECT_EQ(usb_simple::decode_command(packet, digits), usb_simple::Command::kLatchCounters);

  EXPECT_FALSE(usb_simple::decode_command(view(padded({0x50}, 32)), digits));
  EXPECT_FALSE(usb_simple::decode_command(view(padded({0xA2, 0x1B}, 32)), digits));
  EXPECT_FALSE(usb_simple::decode_command(view(padded({0x51}, 31)), digits));
}

TEST(UsbSimple, ReadingHasTwentyFourBitCountersAndInputs) {
  const std::vector<uint8_t> bytes =
      padded({0x00, 0x00, 0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x7F, 0x00, 0x00, 0x80, 0x01,
              0x02, 0x03, 0,    0,    0,    0,    0,    0,    0xFE, 0xFF, 0xFF, 0xA3},
             32);
  CyverseReading reading;
  ASSERT_TRUE(usb_simple::decode_reading(view(bytes), reading));
  const std::array<uint32_t, 8> expected{0, 0xFFFFFF, 0x7FFFFF, 0x800000, 0x030201, 0, 0, 0xFFFFFE};
  EXPECT_EQ(reading.counter, expected);
  EXPECT_EQ(reading.inputs, 0xA3);
  EXPECT_EQ(reading.rotary(), 10);
  usb_simple::Packet packet;
  usb_simple::encode_reading(reading, packet);
  EXPECT_EQ(bytes_of(packet), bytes);
  EXPECT_FALSE(usb_simple::decode_reading(view(padded({}, 31)), reading));
}

// --- UART

const uart_motor::BoardInfo kB3M{5, 1, 4, 4, 0, 0};
const uart_motor::BoardInfo kB5M{7, 1, 8, 0, 4, 0};

TEST(UartMotor, EnquiryHasFortyZerosBeforeAndTwentySixAfter) {
  std::array<uint8_t, uart_motor::kEnquiryLength> packet{};
  uart_motor::encode_enquiry(3, packet);
  std::vector<uint8_t> expected(67, 0);
  expected[40] = 3 | 1 << 3;
  EXPECT_EQ(bytes_of(packet), expected);

  uart_motor::BoardInfo info;
  ASSERT_TRUE(uart_motor::decode_info(view({0x0B, 5, 1, 4, 4, 0, 0}), 3, info));
  EXPECT_EQ(info.model, 5);
  EXPECT_EQ(info.motors, 4);
  EXPECT_EQ(info.currents, 4);
  EXPECT_FALSE(uart_motor::decode_info(view({0x0A, 5, 1, 4, 4, 0, 0}), 3, info));  // board 2
  EXPECT_FALSE(uart_motor::decode_info(view({0x0B, 0, 1, 4, 4, 0, 0}), 3, info));  // no model
  EXPECT_FALSE(uart_motor::decode_info(view({0x0B, 5, 1, 9, 4, 0, 0}), 3, info));  // nine motors
  EXPECT_FALSE(uart_motor::decode_info(view({0x0B, 5, 1, 4, 4, 0}), 3, info));     // short
}

TEST(UartMotor, LengthsAreThoseOfTheFirmware) {
  std::array<uint8_t, uart_motor::kSetLengthsLength> packet{};
  uart_motor::encode_lengths(1, kB3M, packet);
  // After the header, in the order of the commands' numbers, for four motors and no force sensor.
  EXPECT_EQ(bytes_of(packet),
            (std::vector<uint8_t>{0x11, 1, 1, 13, 21, 1, 17, 9, 12, 12, 18, 3, 2}));
  EXPECT_EQ(uart_motor::current_command_length(4), 9u);
  EXPECT_EQ(uart_motor::current_reply_length(4, 0), 17u);
  EXPECT_EQ(uart_motor::current_cycle_length(4, 0), 37u);  // "37 bytes per B3M cycle"
  EXPECT_EQ(uart_motor::current_command_length(8), 17u);
  EXPECT_EQ(uart_motor::current_reply_length(8, 4), 41u);
}

TEST(UartMotor, CurrentIsSignedLittleEndianThenZerosForTheReply) {
  std::array<uint8_t, uart_motor::kMaxCycleLength> packet{};
  packet.fill(0xEE);
  const size_t length = uart_motor::encode_current(2, kB3M, {1, -1, 5000, -4096}, packet);
  const std::vector<uint8_t> sent(packet.begin(), packet.begin() + static_cast<long>(length));
  // 5000 and −4096 are cut to ±4095.
  EXPECT_EQ(sent, padded({0x32, 0x01, 0x00, 0xFF, 0xFF, 0xFF, 0x0F, 0x01, 0xF0}, 37));
  std::array<int, 8> digits{};
  ASSERT_TRUE(uart_motor::decode_current(view(sent), 2, kB3M, digits));
  EXPECT_EQ(digits, (std::array<int, 8>{1, -1, 4095, -4095}));
  EXPECT_FALSE(uart_motor::decode_current(view(sent), 1, kB3M, digits));
  EXPECT_EQ(uart_motor::encode_current(2, kB3M, {}, MutableBytes(packet.data(), 36)), 0u);
}

TEST(UartMotor, ReplyHasPositionsThenVelocities) {
  const std::vector<uint8_t> reply{0x32, 0x01, 0x00, 0xFF, 0xFF, 0x00, 0x80, 0x34, 0x12,
                                   0xFE, 0xFF, 0,    0,    0,    0,    0x07, 0x00};
  uart_motor::Reading reading;
  ASSERT_TRUE(uart_motor::decode_reading(view(reply), 2, kB3M, reading));
  EXPECT_EQ(reading.position[0], 1);
  EXPECT_EQ(reading.position[1], 0xFFFF);
  EXPECT_EQ(reading.position[2], 0x8000);
  EXPECT_EQ(reading.position[3], 0x1234);
  EXPECT_EQ(reading.velocity[0], -2);
  EXPECT_EQ(reading.velocity[3], 7);
  EXPECT_FALSE(uart_motor::decode_reading(view(reply), 3, kB3M, reading));
  EXPECT_FALSE(uart_motor::decode_reading(view(reply), 2, kB5M, reading));
  std::array<uint8_t, uart_motor::kMaxReplyLength> packet{};
  EXPECT_EQ(uart_motor::encode_reading(reading, 2, kB3M, packet), reply.size());
  EXPECT_TRUE(std::equal(reply.begin(), reply.end(), packet.begin()));
}

// --- force feedback

TEST(ForceFeedbackPackets, AreTheKernelsStructures) {
  // struct ff_effect: type, id, direction, trigger, replay, then what is of the type from 16 on.
  std::vector<uint8_t> right = {0x52, 0, 0x03, 0, 0x00, 0x40};
  right = padded(right, 48);
  right[10] = kEffect_ms;
  right[16] = 0xFE;  // −2
  right[17] = 0xFF;
  EXPECT_EQ(bytes_of(ff::encode_constant(3, ff::Direction::kLeft, -2)), right);
  std::vector<uint8_t> rumble = padded({0x50, 0, 0xFF, 0xFF}, 48);
  rumble[10] = kEffect_ms;
  rumble[16] = 0x34;
  rumble[17] = 0x12;
  EXPECT_EQ(bytes_of(ff::encode_rumble(ff::kNewEffect, 0x1234)), rumble);
  // struct input_event: two longs of time, then EV_FF, code, value.
  std::vector<uint8_t> play = padded({}, 24);
  play[16] = 0x15;
  play[18] = 2;
  play[20] = 1;
  EXPECT_EQ(bytes_of(ff::encode_play(2, true)), play);
  play[18] = 0x61;  // FF_AUTOCENTER
  play[20] = 0xCD;
  play[21] = 0xAB;
  EXPECT_EQ(bytes_of(ff::encode_autocentre(0xABCD)), play);
}

TEST(ForceFeedbackPackets, DirectionsAreThoseOfTheKernel) {
  // Documentation of struct ff_effect: 0 down, 0x4000 left, 0x8000 up, 0xC000 right.
  struct Case {
    uint16_t direction;
    double right, up;
  };
  for (const Case c :
       {Case{0, 0, -1}, Case{0x4000, -1, 0}, Case{0x8000, 0, 1}, Case{0xC000, 1, 0}}) {
    const auto bytes =
        ff::encode_constant(0, static_cast<ff::Direction>(c.direction), ff::kFullLevel);
    const auto effect = ff::decode_effect(bytes);
    ASSERT_TRUE(effect);
    EXPECT_NEAR(effect->right, c.right, 1e-9);  // sine and cosine
    EXPECT_NEAR(effect->up, c.up, 1e-9);
  }
  EXPECT_FALSE(ff::decode_effect(view(padded({0x51}, 48))));  // periodic
  EXPECT_FALSE(ff::decode_effect(view(padded({0x52}, 47))));
  EXPECT_FALSE(ff::decode_event(view(padded({}, 24))));
}

TEST(ForceFeedbackPackets, LevelsAreClamped) {
  const auto level = [](int wanted) {
    return ff::decode_effect(ff::encode_constant(0, ff::Direction::kUp, wanted))->up;
  };
  EXPECT_NEAR(level(100'000), 1, 1e-9);
  EXPECT_NEAR(level(-100'000), -1, 1e-9);
  EXPECT_EQ(ff::decode_effect(ff::encode_rumble(0, 100'000))->rumble, 1);
  EXPECT_EQ(ff::decode_effect(ff::encode_rumble(0, -1))->rumble, 0);
}

// --- mouse

/// Little-endian bytes of floats, by the machine's own representation.
std::vector<uint8_t> floats(const std::vector<float>& values) {
  std::vector<uint8_t> bytes(4 * values.size());
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

std::vector<uint8_t> mouse_report(uint8_t command, const std::vector<float>& values) {
  std::vector<uint8_t> bytes = floats(values);
  bytes.insert(bytes.begin(), command);
  return padded(bytes, 64);
}

TEST(SpidarMouse, ReportsAreThePublishedOnes) {
  mouse::Report report;
  mouse::encode_query(report);
  EXPECT_EQ(bytes_of(report), padded({0x82}, 64));
  EXPECT_TRUE(mouse::is_state(report));
  mouse::encode_stop(report);
  EXPECT_EQ(bytes_of(report), padded({0x99}, 64));
  EXPECT_FALSE(mouse::is_state(report));
  mouse::encode_start(report);
  EXPECT_EQ(bytes_of(report), mouse_report(0x80, {0.3F, 1.5F, 47.9867F, 13.1215F}));
  mouse::encode_force({0.6, -0.8}, report);
  EXPECT_EQ(bytes_of(report), mouse_report(0x97, {0, 0, 1.0F, 0.6F, -0.8F}));
}

TEST(SpidarMouse, TotalForceIsLimited) {
  mouse::Report report;
  mouse::encode_force({3, 4}, report);
  EXPECT_EQ(bytes_of(report), mouse_report(0x97, {0, 0, 1.5F, 0.6F, 0.8F}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double x_N : {0.0, nan, std::numeric_limits<double>::infinity()}) {
    mouse::encode_force({x_N, 0}, report);
    EXPECT_EQ(bytes_of(report), padded({0x97}, 64));
  }
  mouse::Command command{};
  Eigen::Vector2d force_N;
  mouse::encode_force({0.6, -0.8}, report);
  ASSERT_TRUE(mouse::decode_command(report, command, force_N));
  EXPECT_EQ(command, mouse::Command::kForce);
  // Two roundings of single precision.
  EXPECT_NEAR(force_N.x(), 0.6, 2e-7);
  EXPECT_NEAR(force_N.y(), -0.8, 2e-7);
  EXPECT_FALSE(mouse::decode_command(view(padded({0x81}, 64)), command, force_N));
}

}  // namespace
}  // namespace spidar::test::protocols_test
