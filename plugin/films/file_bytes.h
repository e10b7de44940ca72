// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace spidar {

inline uint64_t big_endian(const std::string& bytes, size_t at, size_t count) {
  uint64_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | static_cast<uint8_t>(bytes[at + i]);
  return value;
}

inline uint64_t little_endian(std::string bytes, size_t at, size_t count) {
  std::reverse(bytes.begin() + static_cast<int>(at), bytes.begin() + static_cast<int>(at + count));
  return big_endian(bytes, at, count);
}

/// Whether `bytes` contains `text` at `at`; false if there are too few bytes.
inline bool has_at(const std::string& bytes, size_t at, std::string_view text) {
  return bytes.size() >= at + text.size() && bytes.compare(at, text.size(), text) == 0;
}

/// A file that is read at any position; empty when it cannot be read.
class FileBytes {
 public:
  explicit FileBytes(const std::string& path)
      : stream_(path, std::ios::binary | std::ios::ate),
        size_(stream_ ? static_cast<uint64_t>(stream_.tellg()) : 0) {}

  uint64_t size() const { return size_; }
  /// Returns `count` bytes from `at` on; fewer at the end of the file.
  std::string read(uint64_t at, size_t count) {
    std::string bytes(count, '\0');
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(&bytes[0], static_cast<std::streamsize>(count));
    bytes.resize(static_cast<size_t>(stream_.gcount()));
    return bytes;
  }

 private:
  std::ifstream stream_;
  const uint64_t size_;
};

}  // namespace spidar
