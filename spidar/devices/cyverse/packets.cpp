// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/cyverse/packets.h"

#include <algorithm>

namespace spidar {
namespace {

void write_digits(const CyverseDigits& digits, size_t at, MutableBytes bytes) noexcept {
  for (const int digit : digits) {
    bytes.put_u16(at, static_cast<uint16_t>(std::clamp(digit, 0, sh4::kMaxDigit)));
    at += 2;
  }
}

}  // namespace
}  // namespace spidar

namespace spidar::sh4 {
namespace {

constexpr uint8_t kUpdateAll = 0x01;
constexpr uint8_t kBaseAnalyzer = 0x0E;
constexpr size_t kDigitsAt = 2;
constexpr size_t kEchoAt = 0;
constexpr size_t kCounterAt = 16;
constexpr size_t kAdcAt = 32;
constexpr size_t kInputsAt = 48;
constexpr size_t kInfoAt = 50;

}  // namespace

void encode_update(const CyverseDigits& digits, Packet& packet) noexcept {
  packet.fill(0);
  const MutableBytes bytes(packet);
  bytes.put_u8(0, kUpdateAll);
  bytes.put_u8(1, kBaseAnalyzer);
  write_digits(digits, kDigitsAt, bytes);
}

bool decode_update(ByteView packet, CyverseDigits& digits) noexcept {
  if (packet.size != kPacketSize || packet.u8(0) != kUpdateAll || packet.u8(1) != kBaseAnalyzer) {
    return false;
  }
  for (size_t i = 0; i < kChannels; ++i) digits[i] = packet.u16(kDigitsAt + 2 * i);
  return true;
}

void encode_reading(const Reading& reading, Packet& packet) noexcept {
  packet.fill(0);
  const MutableBytes bytes(packet);
  for (size_t i = 0; i < kChannels; ++i) {
    bytes.put_u16(kEchoAt + 2 * i, static_cast<uint16_t>(reading.dac_echo[i]));
    bytes.put_u16(kCounterAt + 2 * i, static_cast<uint16_t>(reading.counter[i]));
    bytes.put_u16(kAdcAt + 2 * i, reading.adc[i]);
  }
  bytes.put_u16(kInputsAt, reading.inputs);
  bytes.put_u32(kInfoAt, reading.info);
}

bool decode_reading(ByteView packet, Reading& reading) noexcept {
  if (packet.size != kPacketSize) return false;
  for (size_t i = 0; i < kChannels; ++i) {
    reading.dac_echo[i] = packet.u16(kEchoAt + 2 * i);
    reading.counter[i] = packet.u16(kCounterAt + 2 * i);
    reading.adc[i] = packet.u16(kAdcAt + 2 * i);
  }
  reading.inputs = packet.u16(kInputsAt);
  reading.info = packet.u32(kInfoAt);
  return true;
}

}  // namespace spidar::sh4

namespace spidar::usb_simple {
namespace {

constexpr uint8_t kControl = 0xA2;
constexpr uint8_t kControlDirection = 0x1A;
constexpr uint8_t kSetDac = 0x52;
constexpr uint8_t kLatch = 0x51;
constexpr size_t kDigitsAt = 1;
constexpr size_t kInputsAt = 3 * kChannels;

}  // namespace

void encode_encoder_direction(uint8_t channels, Packet& packet) noexcept {
  packet.fill(0);
  packet[0] = kControl;
  packet[1] = kControlDirection;
  packet[2] = channels;
}

void encode_set_dac(const CyverseDigits& digits, Packet& packet) noexcept {
  packet.fill(0);
  packet[0] = kSetDac;
  write_digits(digits, kDigitsAt, packet);
}

void encode_latch(Packet& packet) noexcept {
  packet.fill(0);
  packet[0] = kLatch;
}

std::optional<Command> decode_command(ByteView packet, CyverseDigits& digits) noexcept {
  if (packet.size != kPacketSize) return std::nullopt;
  switch (packet.u8(0)) {
    case kControl:
      if (packet.u8(1) != kControlDirection) return std::nullopt;
      return Command::kEncoderDirection;
    case kSetDac:
      for (size_t i = 0; i < kChannels; ++i) digits[i] = packet.u16(kDigitsAt + 2 * i);
      return Command::kSetDac;
    case kLatch:
      return Command::kLatchCounters;
    default:
      return std::nullopt;
  }
}

void encode_reading(const CyverseReading& reading, Packet& packet) noexcept {
  packet.fill(0);
  const MutableBytes bytes(packet);
  for (size_t i = 0; i < kChannels; ++i) bytes.put_u24(3 * i, reading.counter[i]);
  bytes.put_u8(kInputsAt, static_cast<uint8_t>(reading.inputs));
}

bool decode_reading(ByteView packet, CyverseReading& reading) noexcept {
  if (packet.size != kPacketSize) return false;
  for (size_t i = 0; i < kChannels; ++i) reading.counter[i] = packet.u24(3 * i);
  reading.inputs = packet.u8(kInputsAt);
  return true;
}

}  // namespace spidar::usb_simple
