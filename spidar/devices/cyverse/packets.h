// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Packets of the CyVerse USB 2.0 boards, SH4 and Simple. Pure: bytes in, bytes out.
///
/// Sources: haselab-net/SpringheadOne src/Device/DRUsb20Sh4.cpp and DRUsb20Simple.cpp, which talk
/// to the boards through ezusb.sys of Windows; the product id of the Simple board is from
/// Springhead/Springhead core/include/HumanInterface/DRUsb20Simple.h. It is inferred that the pipes
/// are endpoints 2 and 6, that the D/A takes 12 bits, and that the echo of the SH4 board is of the
/// same or an earlier packet.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "spidar/transports/bytes.h"

namespace spidar {

/// Digits of the D/A converters of either board.
using CyverseDigits = std::array<int, 8>;

/// The reading that both boards report.
struct CyverseReading {
  std::array<uint32_t, 8> counter{};  ///< only the bits that the board has
  uint16_t inputs = 0;  ///< bits 4–7: rotary switch; of the Simple board, eight bits

  int rotary() const noexcept { return inputs >> 4 & 0xF; }
};

}  // namespace spidar

namespace spidar::sh4 {

constexpr uint16_t kVendor = 0x0CEC;
constexpr uint16_t kProduct = 0x0205;
constexpr uint8_t kEndpointOut = 0x02;
constexpr uint8_t kEndpointIn = 0x86;
constexpr size_t kPacketSize = 512;
constexpr size_t kChannels = 8;
constexpr int kDacBits = 12;
constexpr int kMaxDigit = (1 << kDacBits) - 1;

using Packet = std::array<uint8_t, kPacketSize>;

/// A reply of the board. The counters have 16 bits, counting in the opposite direction to the
/// Simple board: its host negates them.
struct Reading : CyverseReading {
  CyverseDigits dac_echo{};
  std::array<uint16_t, kChannels> adc{};  ///< digits of 24 V / 4096
  uint32_t info = 0;                      ///< meaning not published
};

/// The only command: sets the D/A digits, which are clamped to kMaxDigit, and asks for all
/// readings.
void encode_update(const CyverseDigits& digits, Packet& packet) noexcept;
/// Returns false when it is not that command, or does not have kPacketSize bytes.
bool decode_update(ByteView packet, CyverseDigits& digits) noexcept;

void encode_reading(const Reading& reading, Packet& packet) noexcept;
/// Returns false when it does not have kPacketSize bytes.
bool decode_reading(ByteView packet, Reading& reading) noexcept;

}  // namespace spidar::sh4

namespace spidar::usb_simple {

constexpr uint16_t kVendor = 0x0CEC;
constexpr uint16_t kProduct = 0x0203;
constexpr uint8_t kEndpointOut = 0x02;
constexpr uint8_t kEndpointIn = 0x86;
constexpr size_t kPacketSize = 32;
constexpr size_t kChannels = 8;
constexpr int kDacBits = 12;
constexpr int kMaxDigit = (1 << kDacBits) - 1;

using Packet = std::array<uint8_t, kPacketSize>;

enum class Command {
  kEncoderDirection,  ///< one bit for each channel: order of the encoder's phases
  kSetDac,
  kLatchCounters,  ///< the next packet from the board holds the counters at this moment
};

void encode_encoder_direction(uint8_t channels, Packet& packet) noexcept;
/// Digits are clamped to kMaxDigit.
void encode_set_dac(const CyverseDigits& digits, Packet& packet) noexcept;
void encode_latch(Packet& packet) noexcept;

/// Nothing when it is none of the commands, or does not have kPacketSize bytes. `digits` is only
/// written with kSetDac.
std::optional<Command> decode_command(ByteView packet, CyverseDigits& digits) noexcept;

/// The board's reply to kLatchCounters. Counters are reduced to 24 bits.
void encode_reading(const CyverseReading& reading, Packet& packet) noexcept;
/// Returns false when it does not have kPacketSize bytes.
bool decode_reading(ByteView packet, CyverseReading& reading) noexcept;

}  // namespace spidar::usb_simple
