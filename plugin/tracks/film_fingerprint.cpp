// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/film_fingerprint.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

namespace spidar {
namespace {

using Bytes = std::pair<const uint8_t*, size_t>;

Bytes after_last_start_code(const uint8_t* data, size_t size) {
  for (size_t i = size; i >= 4; --i) {
    if (data[i - 4] == 0 && data[i - 3] == 0 && data[i - 2] == 1)
      return {data + i - 1, size - i + 1};
  }
  return {data, size};
}

Bytes after_last_length(const uint8_t* data, size_t size, size_t length_bytes) {
  Bytes unit{data, size};
  for (size_t at = 0; at + length_bytes < size;) {
    size_t length = 0;
    for (size_t i = 0; i < length_bytes; ++i) length = length << 8 | data[at + i];
    at += length_bytes;
    if (length == 0 || length > size - at) return unit;
    unit = {data + at, length};
    at += length;
  }
  return unit;
}

/// The largest power of two that is not larger.
size_t floor_to_power(size_t size) {
  size_t power = 1;
  while (power <= size / 2) power *= 2;
  return power;
}

constexpr size_t kDigits = 16;  // of a hash: two films share one of 256 pictures once in 10^14

}  // namespace

PacketFraming framing_of(const GstCaps* caps) {
  PacketFraming framing;
  const GstStructure* structure = gst_caps_get_structure(caps, 0);
  const std::string name = gst_structure_get_name(structure);
  // In ISO/IEC 14496-15, where the configuration says how long the lengths are.
  const bool is_hevc = name == "video/x-h265";
  if (name != "video/x-h264" && !is_hevc) return framing;
  const gchar* format = gst_structure_get_string(structure, "stream-format");
  if (!format || std::string(format) == "byte-stream") {
    framing.kind = PacketFraming::Kind::kStartCodes;
    return framing;
  }
  framing.kind = PacketFraming::Kind::kLengths;
  const GValue* value = gst_structure_get_value(structure, "codec_data");
  GstBuffer* configuration = value ? gst_value_get_buffer(value) : nullptr;
  guint8 lengths = 0;
  if (configuration && gst_buffer_extract(configuration, is_hevc ? 21 : 4, &lengths, 1) == 1) {
    framing.length_bytes = (lengths & 3u) + 1;
  }
  return framing;
}

std::string hash_packet(const uint8_t* data, size_t size, const PacketFraming& framing) {
  Bytes unit{data, size};
  while (unit.second > 0 && unit.first[unit.second - 1] == 0 &&
         framing.kind != PacketFraming::Kind::kLengths) {
    --unit.second;
  }
  if (framing.kind == PacketFraming::Kind::kStartCodes) {
    unit = after_last_start_code(unit.first, unit.second);
  } else if (framing.kind == PacketFraming::Kind::kLengths) {
    unit = after_last_length(unit.first, unit.second, framing.length_bytes);
    while (unit.second > 0 && unit.first[unit.second - 1] == 0) --unit.second;
  }
  const size_t hashed = unit.second == 0 ? 0 : floor_to_power(unit.second);
  gchar* const digits =
      g_compute_checksum_for_data(G_CHECKSUM_SHA1, unit.first + unit.second - hashed, hashed);
  std::string hash(digits, kDigits);
  g_free(digits);
  return hash;
}

FilmFingerprint fingerprint_of(const std::vector<FilmPacket>& packets) {
  const auto largest =
      std::max_element(packets.begin(), packets.end(),
                       [](const FilmPacket& a, const FilmPacket& b) { return a.size < b.size; });
  if (largest == packets.end()) return {};
  return {largest->hash, largest->time_ns};
}

std::string to_text(const FilmFingerprint& fingerprint) {
  return std::to_string(fingerprint.time_ns) + ":" + fingerprint.hash;
}

FilmFingerprint parse_fingerprint(const std::string& text) {
  FilmFingerprint fingerprint;
  char* end = nullptr;
  fingerprint.time_ns = std::strtoll(text.c_str(), &end, 10);
  if (end == text.c_str() || *end != ':') return {};
  fingerprint.hash = end + 1;
  const bool is_hash = fingerprint.hash.size() == kDigits &&
                       fingerprint.hash.find_first_not_of("0123456789abcdef") == std::string::npos;
  return is_hash ? fingerprint : FilmFingerprint();
}

std::optional<int64_t> find_picture(const FilmFingerprint& fingerprint,
                                    const std::vector<FilmPacket>& packets) {
  std::optional<int64_t> later_ns;
  for (const FilmPacket& packet : packets) {
    if (packet.hash != fingerprint.hash) continue;
    // The nearest one, if a picture is repeated.
    const int64_t this_ns = packet.time_ns - fingerprint.time_ns;
    if (!later_ns || std::llabs(this_ns) < std::llabs(*later_ns)) later_ns = this_ns;
  }
  return later_ns;
}

}  // namespace spidar
