// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Packets of the CyVerse USB 2.0 boards, SH4 and Simple. The functions only convert bytes.
///
/// Sources: haselab-net/SpringheadOne src/Device/DRUsb20Sh4.cpp and DRUsb20Simple.cpp, which talk
/// to the boards through ezusb.sys of Windows; the product id of the Simple board is from
/// Springhead/Springhead core/include/HumanInterface/DRUsb20Simple.h. We infer that the pipes are
/// endpoints 2 and 6, that the D/A converter takes 12 bits, and that the echo of the SH4 board
/// belongs to the same or an earlier packet.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "spidar/transports/bytes.h"

namespace spidar {

using CyverseDigits = std::array<int, 8>;

/// The reading that both boards report.
struct CyverseReading {
  std::array<uint32_t, 8> counter{};  ///< only the bits that the board's counters have
  uint16_t inputs = 0;  ///< bits 4–7: rotary switch; the Simple board has eight bits

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

/// A reply of the SH4 board. Its host negates the 16-bit counters, because they count in the
/// opposite direction to those of the Simple board.
struct Reading : CyverseReading {
  CyverseDigits dac_echo{};
  std::array<uint16_t, kChannels> adc{};  ///< digits of 24 V / 4096
  uint32_t info = 0;                      ///< meaning not published
};

/// Encodes the only command, which sets the D/A digits and requests all readings. The digits are
/// clamped to kMaxDigit.
void encode_update(const CyverseDigits& digits, Packet& packet) noexcept;
/// Returns false unless the packet is that command and has kPacketSize bytes.
bool decode_update(ByteView packet, CyverseDigits& digits) noexcept;

void encode_reading(const Reading& reading, Packet& packet) noexcept;
/// Returns false unless the packet has kPacketSize bytes.
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
/// The digits are clamped to kMaxDigit.
void encode_set_dac(const CyverseDigits& digits, Packet& packet) noexcept;
void encode_latch(Packet& packet) noexcept;

/// Returns nothing unless the packet is one of the commands and has kPacketSize bytes. `digits` is
/// written only with kSetDac.
std::optional<Command> decode_command(ByteView packet, CyverseDigits& digits) noexcept;

/// Encodes the board's reply to kLatchCounters. The counters are reduced to 24 bits.
void encode_reading(const CyverseReading& reading, Packet& packet) noexcept;
/// Returns false unless the packet has kPacketSize bytes.
bool decode_reading(ByteView packet, CyverseReading& reading) noexcept;

}  // namespace spidar::usb_simple
