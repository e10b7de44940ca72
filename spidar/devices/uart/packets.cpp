// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/uart/packets.h"

#include <algorithm>

namespace spidar::uart_motor {

std::array<uint8_t, kCommands> command_lengths(size_t motors, size_t forces) noexcept {
  const size_t n = 2 * motors;  // bytes of one number per motor
  const size_t jacobian = forces * n;
  // The lengths of commands 0 … 11: none, info, lengths, all, sensor, direct, current, interpolate,
  // force control, set parameter, reset sensor, get parameter.
  const std::array<size_t, kCommands> length{
      1,
      1,
      kSetLengthsLength,
      5 + n + std::max(n, jacobian),
      1,
      1 + 2 * n,
      1 + n,
      4 + n,
      4 + n + jacobian,
      // The longest parameter has two numbers per motor, or two baud rates.
      2 + std::max<size_t>(2 * n, 8),
      3,
      2,
  };
  std::array<uint8_t, kCommands> bytes{};
  for (size_t i = 0; i < kCommands; ++i) {
    bytes[i] = static_cast<uint8_t>(std::min<size_t>(length[i], 255));
  }
  return bytes;
}

void encode_enquiry(int board, std::array<uint8_t, kEnquiryLength>& packet) noexcept {
  packet.fill(0);
  packet[kZerosBefore] = header(board, Command::kBoardInfo);
}

bool decode_info(ByteView reply, int board, BoardInfo& info) noexcept {
  if (reply.size != kInfoLength || reply.u8(0) != header(board, Command::kBoardInfo)) return false;
  const BoardInfo said{reply.u8(1), reply.u8(2), reply.u8(3),
                       reply.u8(4), reply.u8(5), reply.u8(6)};
  if (said.model == 0 || said.motors == 0 || said.motors > kMaxMotors || said.forces > kMaxMotors) {
    return false;
  }
  info = said;
  return true;
}

void encode_info(const BoardInfo& info, int board,
                 std::array<uint8_t, kInfoLength>& reply) noexcept {
  reply = {header(board, Command::kBoardInfo),
           info.model,
           info.targets,
           info.motors,
           info.currents,
           info.forces,
           info.touches};
}

void encode_lengths(int board, const BoardInfo& info,
                    std::array<uint8_t, kSetLengthsLength>& packet) noexcept {
  packet[0] = header(board, Command::kSetCommandLength);
  const auto lengths = command_lengths(info.motors, info.forces);
  std::copy(lengths.begin(), lengths.end(), packet.begin() + 1);
}

size_t encode_current(int board, const BoardInfo& info, const std::array<int, kMaxMotors>& digits,
                      MutableBytes packet) noexcept {
  const size_t length = current_cycle_length(info.motors, info.forces);
  if (info.motors > kMaxMotors || packet.size < length) return 0;
  MutableBytes(packet.data, length).fill(0);
  packet.put_u8(0, header(board, Command::kCurrent));
  for (size_t i = 0; i < info.motors; ++i) {
    const int digit = std::clamp(digits[i], -kMaxDigit, kMaxDigit);
    packet.put_u16(1 + 2 * i, static_cast<uint16_t>(digit));
  }
  return length;
}

bool decode_current(ByteView command, int board, const BoardInfo& info,
                    std::array<int, kMaxMotors>& digits) noexcept {
  if (info.motors > kMaxMotors || command.size < current_command_length(info.motors) ||
      command.u8(0) != header(board, Command::kCurrent)) {
    return false;
  }
  for (size_t i = 0; i < info.motors; ++i) digits[i] = static_cast<int16_t>(command.u16(1 + 2 * i));
  return true;
}

bool decode_reading(ByteView reply, int board, const BoardInfo& info, Reading& reading) noexcept {
  if (info.motors > kMaxMotors || reply.size != current_reply_length(info.motors, info.forces) ||
      reply.u8(0) != header(board, Command::kCurrent)) {
    return false;
  }
  for (size_t i = 0; i < info.motors; ++i) {
    reading.position[i] = reply.u16(1 + 2 * i);
    reading.velocity[i] = static_cast<int16_t>(reply.u16(1 + 2 * (info.motors + i)));
  }
  return true;
}

size_t encode_reading(const Reading& reading, int board, const BoardInfo& info,
                      MutableBytes reply) noexcept {
  const size_t length = current_reply_length(info.motors, info.forces);
  if (info.motors > kMaxMotors || reply.size < length) return 0;
  MutableBytes(reply.data, length).fill(0);
  reply.put_u8(0, header(board, Command::kCurrent));
  for (size_t i = 0; i < info.motors; ++i) {
    reply.put_u16(1 + 2 * i, reading.position[i]);
    reply.put_u16(1 + 2 * (info.motors + i), static_cast<uint16_t>(reading.velocity[i]));
  }
  return length;
}

}  // namespace spidar::uart_motor
