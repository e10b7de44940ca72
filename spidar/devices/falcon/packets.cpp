// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/falcon/packets.h"

#include <algorithm>

namespace spidar::falcon {
namespace {

constexpr uint8_t kBegin = '<', kEnd = '>', kZero = 'A';
constexpr size_t kNumbersAt = 1, kFlagsAt = 13, kNibbles = 4;
constexpr uint8_t kHomingBit = 1;

void begin(Packet& packet) noexcept {
  packet.fill(kZero);
  packet.front() = kBegin;
  packet.back() = kEnd;
}

void write_number(Packet& packet, size_t index, uint16_t value) noexcept {
  for (size_t i = 0; i < kNibbles; ++i) {
    packet[kNumbersAt + kNibbles * index + i] =
        static_cast<uint8_t>(kZero + (value >> (4 * i) & 0xF));
  }
}

/// Returns whether the packet has the frame and letters for nibbles; the flags may have seven bits.
bool is_packet(ByteView packet) noexcept {
  if (packet.size != kPacketSize || packet.u8(0) != kBegin || packet.u8(kPacketSize - 1) != kEnd) {
    return false;
  }
  for (size_t i = kNumbersAt; i < kFlagsAt; ++i) {
    if (packet.u8(i) < kZero || packet.u8(i) > kZero + 0xF) return false;
  }
  return packet.u8(kFlagsAt) >= kZero && packet.u8(kFlagsAt) <= kZero + 0x7F;
}

int16_t number(ByteView packet, size_t index) noexcept {
  unsigned value = 0;
  for (size_t i = 0; i < kNibbles; ++i) {
    value |= static_cast<unsigned>(packet.u8(kNumbersAt + kNibbles * index + i) - kZero) << (4 * i);
  }
  return static_cast<int16_t>(value);
}

}  // namespace

void encode_command(const Command& command, Packet& packet) noexcept {
  begin(packet);
  for (size_t i = 0; i < command.digit.size(); ++i) {
    write_number(packet, i,
                 static_cast<uint16_t>(std::clamp(command.digit[i], -kMostDigit, kMostDigit)));
  }
  const auto light = static_cast<uint8_t>(command.light);
  packet[kFlagsAt] = static_cast<uint8_t>(kZero + (light | (command.homing ? kHomingBit : 0)));
}

bool decode_command(ByteView packet, Command& command) noexcept {
  if (!is_packet(packet)) return false;
  const int flags = packet.u8(kFlagsAt) - kZero;
  const int light = flags & ~kHomingBit;
  if (light != 0 && light != 2 && light != 4 && light != 8) return false;
  Command decoded;
  for (size_t i = 0; i < decoded.digit.size(); ++i) {
    decoded.digit[i] = number(packet, i);
    if (std::abs(decoded.digit[i]) > kMostDigit) return false;
  }
  decoded.light = static_cast<Light>(light);
  decoded.homing = flags & kHomingBit;
  command = decoded;
  return true;
}

void encode_reading(const Reading& reading, Packet& packet) noexcept {
  begin(packet);
  for (size_t i = 0; i < reading.count.size(); ++i) {
    write_number(packet, i, static_cast<uint16_t>(reading.count[i]));
  }
  packet[kFlagsAt] =
      static_cast<uint8_t>(kZero + ((reading.buttons & 0xF) | (reading.homed & 7) << 4));
}

bool decode_reading(ByteView packet, Reading& reading) noexcept {
  if (!is_packet(packet)) return false;
  for (size_t i = 0; i < reading.count.size(); ++i) reading.count[i] = number(packet, i);
  const int flags = packet.u8(kFlagsAt) - kZero;
  reading.buttons = static_cast<uint8_t>(flags & 0xF);
  reading.homed = static_cast<uint8_t>(flags >> 4);
  return true;
}

}  // namespace spidar::falcon
