// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/text.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fcntl.h>
#include <numeric>
#include <unistd.h>

namespace spidar {
namespace {

/// The length of the first character of a text in bytes; 0 if not UTF-8 (RFC 3629).
size_t first_of(std::string_view text, uint32_t& code) noexcept {
  const auto byte = [&](size_t i) { return static_cast<uint8_t>(text[i]); };
  code = byte(0);
  if (code < 0x80) return 1;
  const size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC0 || byte(0) >= 0xF8 || text.size() < length) return 0;
  code = byte(0) & (0x7Fu >> length);
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  constexpr std::array<uint32_t, 5> kMin{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  if (code < kMin[length] || code > 0x10FFFF || surrogate) return 0;
  return length;
}

bool is_harmless(uint32_t code) noexcept {
  const auto within = [code](uint32_t first, uint32_t last) {
    return code >= first && code <= last;
  };
  return !(code < 0x20 || within(0x7F, 0x9F) ||                // control characters
           within(0x2028, 0x202E) || within(0x2066, 0x2069));  // ends of lines, directions
}

}  // namespace

std::string formatted(const char* pattern, ...) {
  va_list values, counted;
  va_start(values, pattern);
  va_copy(counted, values);
  const int length = std::vsnprintf(nullptr, 0, pattern, counted);
  va_end(counted);
  std::string text(static_cast<size_t>(std::max(length, 0)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, pattern, values);
  va_end(values);
  return text;
}

std::string printable(std::string_view text) {
  std::string printed;
  while (!text.empty()) {
    uint32_t code = 0;
    const size_t length = first_of(text, code);
    if (length > 0 && is_harmless(code)) {
      printed += text.substr(0, length);
    } else {
      printed += '?';
    }
    text.remove_prefix(std::max<size_t>(length, 1));
  }
  return printed;
}

std::string beginning_of(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return {};
  std::array<char, 256> text{};
  const ssize_t length = read(file, text.data(), text.size());
  close(file);
  return {text.data(), static_cast<size_t>(std::max<ssize_t>(length, 0))};
}

std::string first_line(const std::string& path) {
  const std::string text = beginning_of(path);
  return printable(text.substr(0, text.find('\n')));
}

namespace {

/// How many letters must be added, left out or replaced (V. I. Levenshtein, 1966).
size_t edits(const std::string& from, const std::string& to) {
  std::vector<size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < from.size(); ++i) {
    size_t diagonal = row[0]++;
    for (size_t j = 0; j < to.size(); ++j) {
      const size_t replaced = diagonal + (from[i] != to[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string meant(const std::string& word, const std::vector<std::string>& known) {
  std::string nearest;
  // A quarter of the letters may be wrong.
  size_t fewest = std::max<size_t>(1, word.size() / 4) + 1;
  for (const std::string& name : known) {
    const size_t needed = edits(word, name);
    if (needed < fewest) nearest = name;
    fewest = std::min(fewest, needed);
  }
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

}  // namespace spidar
