// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Packets of the CyVerse USB 2.0 SH4 board.
///
/// Source: haselab-net/SpringheadOne src/Device/DRUsb20Sh4.cpp, which talks to the board through
/// ezusb.sys of Windows. It is inferred that the pipes are endpoints 2 and 6, that the D/A takes 12
/// bits, and that the echo is of the same or an earlier packet. Pure: bytes in, bytes out.
#pragma once

#include <array>
#include <cstdint>

#include "spidar/protocols/bytes.h"

namespace spidar::sh4 {

constexpr uint16_t kVendor = 0x0CEC;
constexpr uint16_t kProduct = 0x0205;
constexpr uint8_t kEndpointOut = 0x02;
constexpr uint8_t kEndpointIn = 0x86;
constexpr size_t kPacketSize = 512;
constexpr size_t kChannels = 8;
constexpr double kAdc_V = 24.0 / 4096;  ///< volts per digit of the A/D

using Packet = std::array<uint8_t, kPacketSize>;
using DacDigits = std::array<uint16_t, kChannels>;

/// A reply of the board.
struct Reading {
  DacDigits dac_echo{};
  /// 16 bits, counting in the opposite direction to the Simple board: its host negates them.
  std::array<uint16_t, kChannels> counter{};
  std::array<uint16_t, kChannels> adc{};  ///< digits of kAdc_V
  uint16_t inputs = 0;                    ///< bits 4–7: rotary switch
  uint32_t info = 0;                      ///< meaning not published

  int rotary() const noexcept { return inputs >> 4 & 0xF; }
};

/// The only command: sets the D/A digits and asks for all readings.
void encode_update(const DacDigits& digits, Packet& packet) noexcept;
/// Returns false when it is not that command, or does not have kPacketSize bytes.
bool decode_update(ByteView packet, DacDigits& digits) noexcept;

void encode_reading(const Reading& reading, Packet& packet) noexcept;
/// Returns false when it does not have kPacketSize bytes.
bool decode_reading(ByteView packet, Reading& reading) noexcept;

}  // namespace spidar::sh4
