// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/film_end.h"

#include <algorithm>
#include <cstdint>
#include <fstream>

namespace spidar {
namespace {

uint64_t big_endian(const std::string& bytes, size_t at, size_t count) {
  uint64_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | static_cast<uint8_t>(bytes[at + i]);
  return value;
}

uint64_t little_endian(std::string bytes, size_t at, size_t count) {
  std::reverse(bytes.begin() + static_cast<int>(at), bytes.begin() + static_cast<int>(at + count));
  return big_endian(bytes, at, count);
}

class FilmFile {
 public:
  explicit FilmFile(const std::string& path)
      : stream_(path, std::ios::binary | std::ios::ate),
        size_(stream_ ? static_cast<uint64_t>(stream_.tellg()) : 0) {}

  FilmEnd end() {
    const std::string head = read(0, 12);
    if (head.compare(0, 4, "RIFF") == 0 && head.compare(8, 4, "AVI ") == 0) return end_of_chunks();
    if (head.compare(0, 4, "OggS") == 0) return last_page();
    if (head.size() == 12 && head.compare(4, 4, "ftyp") == 0) return end_of_boxes();
    if (head.compare(0, 4, "\x1a\x45\xdf\xa3") == 0) return end_of_segment();
    return FilmEnd::kUnknown;
  }

 private:
  /// Fewer bytes at the end of the file.
  std::string read(uint64_t at, size_t count) {
    std::string bytes(count, '\0');
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(&bytes[0], static_cast<std::streamsize>(count));
    bytes.resize(static_cast<size_t>(stream_.gcount()));
    return bytes;
  }

  /// An AVI of more than 1 GB consists of several chunks.
  FilmEnd end_of_chunks() {
    for (uint64_t at = 0; at < size_;) {
      const std::string head = read(at, 8);
      if (head.size() < 8 || head.compare(0, 4, "RIFF") != 0)
        return FilmEnd::kWhole;  // after the film
      const uint64_t length = little_endian(head, 4, 4);
      if (length == 0 || length >= 0x7fffffff) return FilmEnd::kUnknown;
      if (length > size_ - at - 8) return FilmEnd::kCutOff;
      at += 8 + length + length % 2;
    }
    return FilmEnd::kWhole;
  }

  /// ISO/IEC 14496-12.
  FilmEnd end_of_boxes() {
    for (uint64_t at = 0; at < size_;) {
      const std::string head = read(at, 16);
      if (head.size() < 8) return FilmEnd::kCutOff;
      uint64_t length = big_endian(head, 0, 4);
      if (length == 1 && head.size() == 16) length = big_endian(head, 8, 8);
      if (length < 8) return FilmEnd::kUnknown;  // 0: it goes on to the end
      if (length > size_ - at) return FilmEnd::kCutOff;
      at += length;
    }
    return FilmEnd::kWhole;
  }

  /// The end of the EBML element (RFC 8794) that begins at `at` with an identifier of four bytes; 0
  /// when its writer did not know it.
  uint64_t end_of_element(uint64_t at) {
    const std::string head = read(at, 12);
    if (head.size() < 12) return 0;
    const auto first = static_cast<uint8_t>(head[4]);
    size_t length = 1;
    while (length <= 8 && !(first & 0x80u >> (length - 1))) ++length;
    if (length > 8) return 0;
    const uint64_t unknown = (uint64_t{1} << 7 * length) - 1;
    const uint64_t size = big_endian(head, 4, length) & unknown;
    return size == unknown ? 0 : at + 4 + length + size;
  }

  /// Matroska and WebM: a header, then the segment.
  FilmEnd end_of_segment() {
    const uint64_t segment = end_of_element(0);
    const uint64_t end = segment > 0 ? end_of_element(segment) : 0;
    if (end == 0) return FilmEnd::kUnknown;
    return end > size_ ? FilmEnd::kCutOff : FilmEnd::kWhole;
  }

  /// The last page of an Ogg ends a stream, and the file (RFC 3533).
  FilmEnd last_page() {
    constexpr size_t kHead = 27, kLongestPage = 65307;
    constexpr uint8_t kEndOfStream = 4;
    const uint64_t from = size_ > kLongestPage ? size_ - kLongestPage : 0;
    const std::string tail = read(from, kLongestPage);
    const size_t page = tail.rfind("OggS");
    if (page == std::string::npos || tail.size() - page < kHead) return FilmEnd::kCutOff;
    const size_t segments = static_cast<uint8_t>(tail[page + kHead - 1]);
    size_t end = page + kHead + segments;
    for (size_t i = 0; i < segments && page + kHead + i < tail.size(); ++i) {
      end += static_cast<uint8_t>(tail[page + kHead + i]);
    }
    const bool is_last = static_cast<uint8_t>(tail[page + 5]) & kEndOfStream;
    return end > tail.size() || !is_last ? FilmEnd::kCutOff : FilmEnd::kWhole;
  }

  std::ifstream stream_;
  const uint64_t size_;
};

}  // namespace

FilmEnd film_end(const std::string& path) {
  return FilmFile(path).end();
}

}  // namespace spidar
