// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Reads from a film, without decoding it, its fingerprint and data to compare with a haptic track.
#pragma once

#include <atomic>
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

/// The framing that the caps of a parsed stream state.
PacketFraming framing_of(const GstCaps* caps);

/// Returns the hash of the end of the last unit of a packet, 16 hexadecimal digits. The hashed part
/// is between a half and all of the unit, because parts that containers add or remove, such as
/// parameter sets and delimiters, come before the picture. Start codes, lengths and zeros at the
/// end are not included.
std::string hash_packet(const uint8_t* data, size_t size, const PacketFraming& framing);

struct FilmPacket {
  std::string hash;  ///< hash_packet()
  size_t size = 0;
  int64_t time_ns = 0;  ///< stream time
};

/// The largest compressed picture at the beginning of a film: pictures that are easy to encode,
/// such as black, are the same in many films. The fingerprint stays when the film is copied into
/// another container, and differs when it is re-encoded.
struct FilmFingerprint {
  std::string hash;
  int64_t time_ns = 0;

  bool empty() const { return hash.empty(); }
};

FilmFingerprint fingerprint_of(const std::vector<FilmPacket>& packets);

/// One word, for the metadata of a track.
std::string to_text(const FilmFingerprint& fingerprint);
/// Returns an empty fingerprint when `text` is none.
FilmFingerprint parse_fingerprint(const std::string& text);

/// How much later the picture of the fingerprint comes in the film that begins with `packets`;
/// nothing when it is another film.
std::optional<int64_t> find_picture(const FilmFingerprint& fingerprint,
                                    const std::vector<FilmPacket>& packets);

struct Film {
  std::vector<FilmPacket> packets;  ///< at its beginning, in the order of the stream
  int64_t begin_ns = 0;             ///< stream time of the first picture
  /// Stream time of the end of the last picture. Nothing when it cannot be found without reading
  /// the whole of a long film.
  std::optional<int64_t> end_ns;
  int64_t duration_ns = 0;  ///< of the longest stream; 0 when the container does not state it
  int64_t frame_ns = 0;     ///< longest time between two pictures at the beginning
  bool has_track = false;   ///< whether a haptic track is inside the film
  bool has_subtitles = false;
  bool is_still = false;  ///< whether it has a single picture, as a cover does
};

/// Reads the beginning and the end of the first video stream of `path`: some megabytes, a short
/// film completely. Throws std::runtime_error, which says what is wrong, when it has no pictures or
/// cannot be read, or when `stopped` has become true.
Film read_film(const std::string& path, const std::atomic<bool>* stopped = nullptr);

}  // namespace spidar
