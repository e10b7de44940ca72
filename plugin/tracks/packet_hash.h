// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Hashes of compressed pictures that are the same in every container.
#pragma once

#include <cstddef>
#include <cstdint>

#include <gst/gst.h>

namespace spidar {

/// How a packet is divided into the units of its codec.
struct PacketFraming {
  enum class Kind { kWhole, kStartCodes, kLengths };
  Kind kind = Kind::kWhole;
  size_t length_bytes = 4;  ///< of the length before each unit, for kLengths
};

/// From the caps of a parsed stream.
PacketFraming framing_of(const GstCaps* caps);

/// Hashes the end of the last unit of a packet: between one half of it and the whole, because what
/// containers add or take away, such as parameter sets and delimiters, comes before the picture.
/// Start codes, lengths and zeros at the end are not included. 0 for an empty packet.
uint32_t hash_packet(const uint8_t* data, size_t size, const PacketFraming& framing);

}  // namespace spidar
