// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/protocols/sh4.h"

namespace spidar::sh4 {
namespace {

constexpr uint8_t kUpdateAll = 0x01;
constexpr uint8_t kBaseAnalyzer = 0x0E;
// Command.
constexpr size_t kDigitsAt = 2;
// Reply.
constexpr size_t kEchoAt = 0;
constexpr size_t kCounterAt = 16;
constexpr size_t kAdcAt = 32;
constexpr size_t kInputsAt = 48;
constexpr size_t kInfoAt = 50;

}  // namespace

void encode_update(const DacDigits& digits, Packet& packet) noexcept {
  packet.fill(0);
  const MutableBytes bytes(packet);
  bytes.put_u8(0, kUpdateAll);
  bytes.put_u8(1, kBaseAnalyzer);
  for (size_t i = 0; i < kChannels; ++i) bytes.put_u16(kDigitsAt + 2 * i, digits[i]);
}

bool decode_update(ByteView packet, DacDigits& digits) noexcept {
  if (packet.size != kPacketSize || packet.u8(0) != kUpdateAll || packet.u8(1) != kBaseAnalyzer)
    return false;
  for (size_t i = 0; i < kChannels; ++i) digits[i] = packet.u16(kDigitsAt + 2 * i);
  return true;
}

void encode_reading(const Reading& reading, Packet& packet) noexcept {
  packet.fill(0);
  const MutableBytes bytes(packet);
  for (size_t i = 0; i < kChannels; ++i) {
    bytes.put_u16(kEchoAt + 2 * i, reading.dac_echo[i]);
    bytes.put_u16(kCounterAt + 2 * i, reading.counter[i]);
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
