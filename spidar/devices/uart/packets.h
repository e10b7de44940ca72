// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Packets of the UART motor boards: 2 Mbaud, 8N1, up to eight boards on a half-duplex bus.
///
/// Sources: Springhead/Springhead core/src/HumanInterface/DRUartMotorDriver* and its
/// PIC/commandTemplate.h; haselab-net/StuffedV3 PIC/. The functions only convert bytes.
#pragma once

#include <array>
#include <cstdint>

#include "spidar/transports/bytes.h"

namespace spidar::uart_motor {

constexpr int kBaud = 2'000'000;
constexpr int kMaxBoards = 8;
constexpr size_t kMaxMotors = 8;
constexpr int kDacBits = 12;
constexpr double kDac_V = 3.3;  ///< range of the D/A, of either sign
constexpr double kDigitsPerVolt = (1 << kDacBits) / kDac_V;
constexpr int kMaxDigit = (1 << kDacBits) - 1;  ///< of either sign
constexpr size_t kCommands = 12;

enum class Command : uint8_t {
  kBoardInfo = 1,
  kSetCommandLength = 2,
  kCurrent = 6,
};

/// A board's description of itself. Supported boards have 1 … kMaxMotors motors.
struct BoardInfo {
  uint8_t model = 0;  ///< 5: B3M, 7: B5M
  uint8_t targets = 0;
  uint8_t motors = 0;
  uint8_t currents = 0;
  uint8_t forces = 0;
  uint8_t touches = 0;
};

/// Answer to kCurrent.
struct Reading {
  std::array<uint16_t, kMaxMotors> position{};  ///< 16-bit counter
  std::array<int16_t, kMaxMotors> velocity{};   ///< counts; unit of time not published
};

constexpr uint8_t header(int board, Command command) noexcept {
  return static_cast<uint8_t>((board & 7) | static_cast<int>(command) << 3);
}

/// The number of zeros before an enquiry, which complete a packet that a board still expects.
constexpr size_t kZerosBefore = 40;
/// The number of zeros after an enquiry, during which the board replies.
constexpr size_t kZerosAfter = 26;
constexpr size_t kEnquiryLength = kZerosBefore + 1 + kZerosAfter;
constexpr size_t kInfoLength = 7;
constexpr size_t kSetLengthsLength = 1 + kCommands;

constexpr size_t current_command_length(size_t motors) noexcept {
  return 1 + 2 * motors;
}
constexpr size_t current_reply_length(size_t motors, size_t forces) noexcept {
  return 1 + 4 * motors + 2 * forces;
}
/// Includes the zeros during which the board replies.
constexpr size_t current_cycle_length(size_t motors, size_t forces) noexcept {
  const size_t command = current_command_length(motors);
  const size_t reply = current_reply_length(motors, forces);
  const size_t zeros = reply + 20 > command + 5 ? reply + 20 - command : 5;
  return command + zeros;
}
constexpr size_t kMaxCycleLength = current_cycle_length(kMaxMotors, kMaxMotors);
constexpr size_t kMaxReplyLength = current_reply_length(kMaxMotors, kMaxMotors);

/// Lengths of a board's commands, in the order of their numbers.
std::array<uint8_t, kCommands> command_lengths(size_t motors, size_t forces) noexcept;

void encode_enquiry(int board, std::array<uint8_t, kEnquiryLength>& packet) noexcept;
/// Returns false unless the reply is that board's and its content is valid.
bool decode_info(ByteView reply, int board, BoardInfo& info) noexcept;
void encode_info(const BoardInfo& info, int board,
                 std::array<uint8_t, kInfoLength>& reply) noexcept;

/// Encodes the lengths of the other boards' packets, which a board needs to skip them.
void encode_lengths(int board, const BoardInfo& info,
                    std::array<uint8_t, kSetLengthsLength>& packet) noexcept;

/// Encodes one servo cycle of one board. Digits are clamped to ±kMaxDigit. Returns the length, or 0
/// when `packet` is too small or the board has too many motors.
size_t encode_current(int board, const BoardInfo& info, const std::array<int, kMaxMotors>& digits,
                      MutableBytes packet) noexcept;
bool decode_current(ByteView command, int board, const BoardInfo& info,
                    std::array<int, kMaxMotors>& digits) noexcept;

/// Returns false unless the reply is that board's and has its length.
bool decode_reading(ByteView reply, int board, const BoardInfo& info, Reading& reading) noexcept;
/// Returns the length, or 0 when `reply` is too small.
size_t encode_reading(const Reading& reading, int board, const BoardInfo& info,
                      MutableBytes reply) noexcept;

}  // namespace spidar::uart_motor
