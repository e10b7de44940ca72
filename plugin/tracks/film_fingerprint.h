// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a film is recognised by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

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

/// A compressed picture.
struct FilmPacket {
  uint32_t hash = 0;  ///< hash_packet()
  size_t size = 0;
  int64_t time_ns = 0;  ///< stream time
};

/// Compressed pictures from the beginning of a film. They remain the same when the film is copied
/// into another container, and differ when it is encoded anew.
struct FilmFingerprint {
  static constexpr size_t kPackets = 16;

  /// Hashes of the largest packets, the largest first, at most kPackets. What is easy to encode,
  /// such as black, is the same in many films.
  std::vector<uint32_t> hashes;
  int64_t time_ns = 0;  ///< of the largest

  bool empty() const { return hashes.empty(); }
};

FilmFingerprint fingerprint_of(std::vector<FilmPacket> packets);

/// One word, for the metadata of a track.
std::string to_text(const FilmFingerprint& fingerprint);
/// An empty one when `text` is none.
FilmFingerprint parse_fingerprint(const std::string& text);

/// How much later the pictures of the fingerprint come in the film that begins with `packets`;
/// nothing when it is another film. Half of the pictures are enough, because containers may lose
/// some at their beginning.
std::optional<int64_t> find_pictures(const FilmFingerprint& fingerprint,
                                     const std::vector<FilmPacket>& packets);

}  // namespace spidar
