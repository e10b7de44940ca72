// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Packets of the Novint Falcon, behind its FTDI chip. The functions only convert bytes.
///
/// Source: libnifalcon, src/comm/FalconCommLibUSB.cpp (line, loading),
/// src/firmware/FalconFirmwareNovintSDK.cpp (packets of the maker's firmware),
/// include/falcon/core/FalconKinematic.h (encoders) and src/kinematic/FalconKinematicStamper.cpp
/// (motors). Where its documentation of the homing bit contradicts its code, we follow the code.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "spidar/transports/bytes.h"
#include "spidar/transports/ftdi.h"

namespace spidar::falcon {

constexpr uint16_t kVendor = 0x0403;
constexpr uint16_t kProduct = 0xCB48;
constexpr uint8_t kEndpointOut = 0x02;
constexpr uint8_t kEndpointIn = 0x81;

// --- Loading the firmware, which the device forgets without power.

constexpr uint16_t kHelloBaud = 0x4138;  ///< divisor of 9600 baud
constexpr uint16_t kLoadBaud = 0x0015;   ///< divisor of 143 kbaud
constexpr uint16_t kRunBaud = 0x0002;    ///< divisor of 1.5 Mbaud

/// Requests before the hello. Toggling DTR starts the loader.
inline constexpr std::array kHelloLine{
    ftdi::kDropReceived, ftdi::kDropSent,      ftdi::latency_ms(16), ftdi::baud_divisor(kHelloBaud),
    ftdi::kEightBits,    ftdi::kNoFlowControl, ftdi::kRtsLow,        ftdi::kDtrLow,
    ftdi::kDtrHigh};
inline constexpr std::array<uint8_t, 3> kHello{0x0A, 0x43, 0x0D};
/// A zero byte may precede this answer.
inline constexpr std::array<uint8_t, 4> kHelloAnswer{0x0A, 0x44, 0x2C, 0x0D};

/// Requests between hello and firmware; then the device echoes kLoad and the pieces of firmware.
inline constexpr std::array kLoadLine{ftdi::kDtrLow, ftdi::baud_divisor(kLoadBaud)};
inline constexpr std::array<uint8_t, 1> kLoad{'A'};
constexpr size_t kPieceSize = ftdi::kPacketSize - ftdi::kStatusSize;

/// Requests after the firmware, or when the device already has its firmware.
inline constexpr std::array kRunLine{ftdi::latency_ms(1), ftdi::baud_divisor(kRunBaud),
                                     ftdi::kDropReceived, ftdi::kDropSent};

// --- Packets of the running firmware: '<', 14 letters 'A' + number, '>'. Numbers are split into
// nibbles, the lowest first. The device answers every command.

constexpr size_t kPacketSize = 16;
using Packet = std::array<uint8_t, kPacketSize>;

constexpr int kMostDigit = 4095;  ///< the largest digit of a motor, which has 12 bits and a sign
/// Digits of a motor per N m at its arm; positive digits pull the arm towards the base. The number
/// is libnifalcon's; nobody states how it was measured.
constexpr double kDigitsPerNm = -10000;

enum class Light : uint8_t { kNone = 0, kGreen = 2, kBlue = 4, kRed = 8 };

struct Command {
  std::array<int, 3> digit{};  ///< for the motors, clockwise from the top as the user sees them
  Light light = Light::kNone;
  /// The encoders find their marks while the grip passes them, and remember them.
  bool homing = true;
};

struct Reading {
  std::array<int16_t, 3> count{};  ///< counts of the encoders, see angle_rad()
  uint8_t buttons = 0;             ///< bits 0–3: right, forward, centre, left
  uint8_t homed = 0;               ///< bits 0–2: encoders that have found their marks
  bool all_homed() const noexcept { return homed == 7; }
};

/// The digits are clamped to ±kMostDigit.
void encode_command(const Command& command, Packet& packet) noexcept;
bool decode_command(ByteView packet, Command& command) noexcept;
void encode_reading(const Reading& reading, Packet& packet) noexcept;
bool decode_reading(ByteView packet, Reading& reading) noexcept;

/// A motor drum of 14.25 mm winds a cable around an arm's drum of 110 mm; the motor's encoder
/// counts 1280 steps a turn. Zero is at 35 degrees (approximately, says libnifalcon).
constexpr double kRadiansPerCount = 2 * M_PI / 1280 * 14.25 / 110;
constexpr double kAngleAtZero_rad = 35 * M_PI / 180;
constexpr double angle_rad(int count) noexcept {
  return kAngleAtZero_rad + kRadiansPerCount * count;
}
inline int16_t count_at(double angle_rad) noexcept {
  return static_cast<int16_t>(std::lround((angle_rad - kAngleAtZero_rad) / kRadiansPerCount));
}

}  // namespace spidar::falcon
