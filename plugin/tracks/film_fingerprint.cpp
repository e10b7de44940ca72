// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/film_fingerprint.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
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

constexpr size_t kDigits = 8;  // of a hash

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

uint32_t hash_packet(const uint8_t* data, size_t size, const PacketFraming& framing) {
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
  if (unit.second == 0) return 0;
  // FNV-1a of 64 bits, folded.
  uint64_t hash = 0xcbf29ce484222325u;
  for (size_t i = unit.second - floor_to_power(unit.second); i < unit.second; ++i) {
    hash = (hash ^ unit.first[i]) * 0x100000001b3u;
  }
  return static_cast<uint32_t>(hash ^ hash >> 32);
}

FilmFingerprint fingerprint_of(std::vector<FilmPacket> packets) {
  std::stable_sort(packets.begin(), packets.end(),
                   [](const FilmPacket& a, const FilmPacket& b) { return a.size > b.size; });
  FilmFingerprint fingerprint;
  std::vector<uint32_t>& hashes = fingerprint.hashes;
  for (const FilmPacket& packet : packets) {
    if (hashes.size() == FilmFingerprint::kPackets) break;
    const bool is_new = std::find(hashes.begin(), hashes.end(), packet.hash) == hashes.end();
    if (is_new) hashes.push_back(packet.hash);
  }
  if (!packets.empty()) fingerprint.time_ns = packets.front().time_ns;
  return fingerprint;
}

std::string to_text(const FilmFingerprint& fingerprint) {
  std::string text = std::to_string(fingerprint.time_ns) + ":";
  for (const uint32_t hash : fingerprint.hashes) {
    char digits[kDigits + 1];
    std::snprintf(digits, sizeof digits, "%08" PRIx32, hash);
    text += digits;
  }
  return text;
}

FilmFingerprint parse_fingerprint(const std::string& text) {
  const size_t colon = text.find(':');
  if (colon == std::string::npos || colon == 0) return {};
  const std::string time = text.substr(0, colon), digits = text.substr(colon + 1);
  const bool has_digits = !digits.empty() && digits.size() % kDigits == 0 &&
                          digits.size() <= FilmFingerprint::kPackets * kDigits &&
                          digits.find_first_not_of("0123456789abcdef") == std::string::npos;
  FilmFingerprint fingerprint;
  char* end = nullptr;
  fingerprint.time_ns = std::strtoll(time.c_str(), &end, 10);
  if (*end != '\0' || !has_digits) return {};
  for (size_t i = 0; i < digits.size(); i += kDigits) {
    fingerprint.hashes.push_back(
        static_cast<uint32_t>(std::strtoul(digits.substr(i, kDigits).c_str(), nullptr, 16)));
  }
  return fingerprint;
}

std::optional<int64_t> find_pictures(const FilmFingerprint& fingerprint,
                                     const std::vector<FilmPacket>& packets) {
  std::optional<int64_t> later_ns;
  size_t found = 0;
  for (const uint32_t hash : fingerprint.hashes) {
    bool is_there = false;
    for (const FilmPacket& packet : packets) {
      if (packet.hash != hash) continue;
      is_there = true;
      if (hash != fingerprint.hashes.front()) break;
      // The nearest one, if a picture is repeated.
      const int64_t this_ns = packet.time_ns - fingerprint.time_ns;
      if (!later_ns || std::llabs(this_ns) < std::llabs(*later_ns)) later_ns = this_ns;
    }
    if (is_there) ++found;
  }
  if (2 * found < fingerprint.hashes.size()) return std::nullopt;
  return later_ns;
}

}  // namespace spidar
