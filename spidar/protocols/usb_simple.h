// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Packets of the CyVerse USB 2.0 Simple board.
///
/// Source: haselab-net/SpringheadOne src/Device/DRUsb20Simple.cpp; the product id is from
/// Springhead/Springhead core/include/HumanInterface/DRUsb20Simple.h. That its pipes are endpoints
/// 2 and 6 and that the D/A takes 12 bits is inferred. Pure: bytes in, bytes out.
#pragma once

#include <array>
#include <cstdint>

#include "core/api.h"
#include "spidar/protocols/bytes.h"

namespace spidar::usb_simple {

constexpr uint16_t kVendor = 0x0CEC;
constexpr uint16_t kProduct = 0x0203;
constexpr uint8_t kEndpointOut = 0x02;
constexpr uint8_t kEndpointIn = 0x86;
constexpr size_t kPacketSize = 32;
constexpr size_t kChannels = 8;

using Packet = std::array<uint8_t, kPacketSize>;
using DacDigits = std::array<uint16_t, kChannels>;

enum class Command {
  kEncoderDirection,  ///< a bit per channel: order of the encoder's phases
  kClearCounters,     ///< a bit per channel
  kSetDac,
  kLatchCounters,  ///< the next packet from the board holds the counters of this moment
};

/// What the board answers to kLatchCounters.
struct Reading {
  std::array<int32_t, kChannels> counter{};  ///< 24 bits, sign extended
  uint8_t inputs = 0;                        ///< bits 4–7: rotary switch

  int rotary() const noexcept { return inputs >> 4 & 0xF; }
};

SPIDAR_API void encode_encoder_direction(uint8_t channels, Packet& packet) noexcept;
SPIDAR_API void encode_clear_counters(uint8_t channels, Packet& packet) noexcept;
SPIDAR_API void encode_set_dac(const DacDigits& digits, Packet& packet) noexcept;
SPIDAR_API void encode_latch(Packet& packet) noexcept;

/// What a packet to the board says.
struct HostPacket {
  Command command = Command::kLatchCounters;
  uint8_t channels = 0;  ///< of kEncoderDirection and kClearCounters
  DacDigits digits{};    ///< of kSetDac
};

/// False when it is none of the commands, or not of kPacketSize.
SPIDAR_API bool decode_command(ByteView packet, HostPacket& command) noexcept;

/// Counters are cut to 24 bits.
SPIDAR_API void encode_reading(const Reading& reading, Packet& packet) noexcept;
/// False when it is not of kPacketSize.
SPIDAR_API bool decode_reading(ByteView packet, Reading& reading) noexcept;

}  // namespace spidar::usb_simple
