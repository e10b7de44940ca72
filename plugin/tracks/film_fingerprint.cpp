// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tracks/film_fingerprint.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>

namespace spidar {
namespace {

constexpr size_t kDigits = 8;  // of a hash

}  // namespace

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
