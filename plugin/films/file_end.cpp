// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/films/file_end.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>

#include "plugin/films/file_bytes.h"

namespace spidar {
namespace {

/// Whether a size of 32 bits is one of those that writers leave when they cannot seek back: the
/// largest size with or without a sign, less a part of the header (sox writes 0x7ffff000 minus a
/// remainder), or only the first bit.
bool is_unknown_size(uint64_t size) {
  constexpr uint64_t kRange = uint64_t{1} << 31, kHeads = uint64_t{1} << 16;
  return size % kRange == 0 || size % kRange >= kRange - kHeads;
}

/// An AVI of more than 1 GB consists of several chunks.
FilmEnd end_of_chunks(FileBytes& file) {
  for (uint64_t at = 0; at < file.size();) {
    const std::string head = file.read(at, 8);
    if (head.size() < 8 || !has_at(head, 0, "RIFF")) return FilmEnd::kAppended;
    const uint64_t length = little_endian(head, 4, 4);
    if (is_unknown_size(length)) return FilmEnd::kUnknown;
    if (length > file.size() - at - 8) return FilmEnd::kCutOff;
    at += 8 + length + length % 2;
  }
  return FilmEnd::kWhole;
}

/// Whether `type` is that of a top-level box.
bool is_box(const std::string& type) {
  constexpr const char* kTypes[] = {"emsg", "free", "ftyp", "mdat", "meta", "mfra",
                                    "moof", "moov", "pdin", "pnot", "prft", "sidx",
                                    "skip", "ssix", "styp", "udta", "uuid", "wide"};
  return std::any_of(std::begin(kTypes), std::end(kTypes),
                     [&type](const char* one) { return type == one; });
}

/// ISO/IEC 14496-12. Data after a complete film that are not a box were appended by another
/// program.
FilmEnd end_of_boxes(FileBytes& file) {
  bool has_index = false, has_pictures = false, has_fragments = false;
  for (uint64_t at = 0; at < file.size();) {
    const std::string head = file.read(at, 16);
    const std::string type = head.size() < 8 ? "" : head.substr(4, 4);
    const bool is_complete = has_index && has_pictures;
    if (!is_box(type) && is_complete && !(head.size() < 8 && has_fragments)) {
      return FilmEnd::kAppended;
    }
    if (head.size() < 8) return FilmEnd::kCutOff;
    uint64_t length = big_endian(head, 0, 4);
    if (length == 1 && head.size() == 16) length = big_endian(head, 8, 8);
    if (length < 8) return FilmEnd::kUnknown;  // 0: it extends to the end
    if (length > file.size() - at) return FilmEnd::kCutOff;
    at += length;
    has_index = has_index || type == "moov";
    has_pictures = has_pictures || type == "mdat";
    has_fragments = has_fragments || type == "moof";
  }
  return FilmEnd::kWhole;
}

/// The end of the EBML element (RFC 8794) that begins at `at` with an identifier of four bytes; 0
/// when its writer did not know it.
uint64_t end_of_element(FileBytes& file, uint64_t at) {
  const std::string head = file.read(at, 12);
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
FilmEnd end_of_segment(FileBytes& file) {
  const uint64_t segment = end_of_element(file, 0);
  const uint64_t end = segment > 0 ? end_of_element(file, segment) : 0;
  if (end == 0) return FilmEnd::kUnknown;
  return end > file.size() ? FilmEnd::kCutOff : FilmEnd::kWhole;
}

/// The last page of an Ogg ends a stream, and the file (RFC 3533).
FilmEnd last_page(FileBytes& file) {
  constexpr size_t kHead = 27, kLongestPage = 65307;
  constexpr uint8_t kEndOfStream = 4;
  const uint64_t from = file.size() > kLongestPage ? file.size() - kLongestPage : 0;
  const std::string tail = file.read(from, kLongestPage);
  const size_t page = tail.rfind("OggS");
  if (page == std::string::npos) return FilmEnd::kUnknown;  // more than a page has been appended
  if (tail.size() - page < kHead) return FilmEnd::kCutOff;
  const size_t segments = static_cast<uint8_t>(tail[page + kHead - 1]);
  size_t end = page + kHead + segments;
  for (size_t i = 0; i < segments && page + kHead + i < tail.size(); ++i) {
    end += static_cast<uint8_t>(tail[page + kHead + i]);
  }
  const bool is_last = static_cast<uint8_t>(tail[page + 5]) & kEndOfStream;
  return end > tail.size() || !is_last ? FilmEnd::kCutOff : FilmEnd::kWhole;
}

FilmEnd end_of(FileBytes& file) {
  const std::string head = file.read(0, 12);
  if (has_at(head, 0, "RIFF") && has_at(head, 8, "AVI ")) return end_of_chunks(file);
  if (has_at(head, 0, "OggS")) return last_page(file);
  if (head.size() == 12 && has_at(head, 4, "ftyp")) return end_of_boxes(file);
  if (has_at(head, 0, "\x1a\x45\xdf\xa3")) return end_of_segment(file);
  return FilmEnd::kUnknown;
}

int64_t time_ns(uint64_t samples, uint64_t rate_Hz) {
  return std::llround(1e9 * static_cast<double>(samples) / static_cast<double>(rate_Hz));
}

/// Reads the chunk "data" of a WAV file. wavparse plays what is there.
FileLength length_of_wav(FileBytes& file) {
  uint64_t rate_Hz = 0, sample_bytes = 0;
  for (uint64_t at = 12; at < file.size();) {
    const std::string head = file.read(at, 8);
    if (head.size() < 8) break;
    const uint64_t promised = little_endian(head, 4, 4);
    if (has_at(head, 0, "fmt ")) {
      const std::string format = file.read(at + 8, 16);
      if (format.size() < 16) break;
      rate_Hz = little_endian(format, 4, 4);
      sample_bytes = little_endian(format, 12, 2);
    }
    if (has_at(head, 0, "data")) {
      if (rate_Hz == 0 || sample_bytes == 0) break;
      const uint64_t there =
          std::min(file.size() - at - 8, is_unknown_size(promised) ? UINT64_MAX : promised);
      FileLength length;
      length.by_samples = true;
      length.available_ns = time_ns(there / sample_bytes, rate_Hz);
      if (!is_unknown_size(promised)) {
        length.declared_ns = time_ns(promised / sample_bytes, rate_Hz);
      }
      return length;
    }
    at += 8 + promised + promised % 2;
  }
  return {};
}

/// In samples of the stream; if its beginning was trimmed, the first frame does not begin at 0.
struct FlacLength {
  uint64_t rate_Hz = 0;         ///< 0: there is no header
  uint64_t promised = 0;        ///< by the header; 0: its writer did not know
  uint64_t begin = 0;           ///< of the first frame
  std::optional<uint64_t> end;  ///< of the last whole frame; nothing when none was found
  bool is_cut_off = false;      ///< within the frame after `end`
};

constexpr size_t kLongestHead = 16;  // of a frame, in bytes

/// What the header states for all frames.
struct StreamInfo {
  uint64_t block_samples = 0;  ///< of all frames but the last, where they are equally long
  uint64_t rate_Hz = 0;
  uint64_t channels = 0;
  uint64_t samples = 0;
};

struct FlacFrame {
  uint64_t begin = 0, samples = 0;
};

uint8_t crc8(const std::string& bytes, size_t from, size_t to) {
  unsigned crc = 0;
  for (size_t i = from; i < to; ++i) {
    crc ^= static_cast<uint8_t>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1U ^ (crc & 0x80U ? 0x07U : 0)) & 0xffU;
  }
  return static_cast<uint8_t>(crc);
}

/// Returns the end of the frame that begins at `from`: after its checksum, the CRC is 0. Returns
/// nothing when the frame is incomplete.
std::optional<size_t> end_of_frame(const std::string& bytes, size_t from) {
  unsigned crc = 0;
  for (size_t i = from; i < bytes.size(); ++i) {
    crc ^= static_cast<unsigned>(static_cast<uint8_t>(bytes[i])) << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1U ^ (crc & 0x8000U ? 0x8005U : 0)) & 0xffffU;
    if (crc == 0 && i > from) return i + 1;
  }
  return std::nullopt;
}

/// Whether another frame, or only its first byte, begins at `from`. What taggers append does not
/// begin like a frame.
bool begins_frame(const std::string& bytes, size_t from) {
  const auto byte = [&bytes](size_t i) { return static_cast<uint8_t>(bytes[i]); };
  return from < bytes.size() && byte(from) == 0xff &&
         (from + 1 == bytes.size() || (byte(from + 1) & 0xfeU) == 0xf8);
}

/// The number of a frame or a sample, coded like a character in UTF-8 but up to 36 bits long.
std::optional<uint64_t> coded_number(const std::string& bytes, size_t& at) {
  if (at >= bytes.size()) return std::nullopt;
  const unsigned first = static_cast<uint8_t>(bytes[at++]);
  size_t more = 0;
  while (more < 7 && first & 0x80U >> more) ++more;
  if (more == 1) return std::nullopt;
  uint64_t number = more == 0 ? first : first & (0x7fU >> more);
  for (size_t i = 1; i < more; ++i) {
    if (at >= bytes.size()) return std::nullopt;
    const unsigned next = static_cast<uint8_t>(bytes[at++]);
    if ((next & 0xc0U) != 0x80U) return std::nullopt;
    number = number << 6U | (next & 0x3fU);
  }
  return number;
}

/// Section 9.1: a frame whose head is at `from`.
std::optional<FlacFrame> frame_at(const std::string& bytes, size_t from, const StreamInfo& info) {
  if (bytes.size() - from < 6) return std::nullopt;
  const auto byte = [&](size_t i) {
    return static_cast<unsigned>(static_cast<uint8_t>(bytes[from + i]));
  };
  if (byte(0) != 0xff || (byte(1) & 0xfeU) != 0xf8) return std::nullopt;
  const unsigned size_code = byte(2) >> 4U, rate_code = byte(2) & 0xfU,
                 channel_code = byte(3) >> 4U;
  const uint64_t channels = channel_code < 8 ? channel_code + 1 : 2;
  if (size_code == 0 || rate_code == 15 || channel_code > 10 || channels != info.channels) {
    return std::nullopt;
  }
  size_t at = from + 4;
  const std::optional<uint64_t> number = coded_number(bytes, at);
  const size_t more_bytes = size_code == 6 ? 1 : size_code == 7 ? 2 : 0;
  const size_t rate_bytes = rate_code == 12 ? 1 : rate_code > 12 ? 2 : 0;
  if (!number || at + more_bytes + rate_bytes >= bytes.size()) return std::nullopt;
  FlacFrame frame;
  frame.samples = more_bytes > 0   ? big_endian(bytes, at, more_bytes) + 1
                  : size_code == 1 ? 192
                  : size_code < 6  ? uint64_t{576} << (size_code - 2)
                                   : uint64_t{256} << (size_code - 8);
  at += more_bytes + rate_bytes;
  if (at - from > kLongestHead || crc8(bytes, from, at + 1) != 0) return std::nullopt;
  frame.begin = byte(1) & 1U ? *number : *number * info.block_samples;
  return frame;
}

/// Section 8.2; `at` is moved to the first frame.
std::optional<StreamInfo> read_head(FileBytes& file, uint64_t& at) {
  const std::string block = file.read(8, 18);
  if (block.size() < 18) return std::nullopt;
  StreamInfo info;
  info.block_samples = big_endian(block, 2, 2);
  const uint64_t packed = big_endian(block, 10, 8);
  info.rate_Hz = packed >> 44U;
  info.channels = (packed >> 41U & 7U) + 1;
  info.samples = packed & ((uint64_t{1} << 36U) - 1);
  for (at = 4;;) {
    const std::string head = file.read(at, 4);
    if (head.size() < 4) return std::nullopt;
    at += 4 + big_endian(head, 1, 3);
    if (static_cast<uint8_t>(head[0]) & 0x80U) return info;
  }
}

/// Where the first frame of a FLAC file begins and the last one ends (RFC 9639).
FlacLength flac_length(FileBytes& file) {
  FlacLength length;
  uint64_t first = 0;
  const std::optional<StreamInfo> info = read_head(file, first);
  if (!info) return length;
  length.rate_Hz = info->rate_Hz;
  length.promised = info->samples;
  // Longer frames (up to 65535 samples of 32 bits in eight channels) are rare, as are longer
  // appended data.
  constexpr uint64_t kEnd = uint64_t{1} << 18U;
  const uint64_t from = file.size() > first + kEnd ? file.size() - kEnd : first;
  const std::string end = file.read(from, kEnd);
  if (const auto frame = frame_at(file.read(first, kLongestHead + 1), 0, *info)) {
    length.begin = frame->begin;
  }
  for (size_t at = end.size(); at-- > 0;) {
    const std::optional<FlacFrame> frame = frame_at(end, at, *info);
    const std::optional<size_t> after = frame ? end_of_frame(end, at) : std::nullopt;
    if (!after) continue;
    length.end = frame->begin + frame->samples;
    length.is_cut_off = begins_frame(end, *after);
    return length;
  }
  return length;
}

/// A file counts as cut off only if its last frame is incomplete, whatever its header states:
/// programs that trim a file copy whole frames and leave the old length in the header.
FileLength length_of_flac(FileBytes& file) {
  const FlacLength flac = flac_length(file);
  if (flac.rate_Hz == 0 || !flac.end || *flac.end < flac.begin) return {};
  FileLength length;
  length.by_samples = true;
  length.available_ns = time_ns(*flac.end - flac.begin, flac.rate_Hz);
  length.is_cut_off = flac.is_cut_off;
  if (flac.is_cut_off && flac.promised > *flac.end) {
    length.declared_ns = time_ns(flac.promised - flac.begin, flac.rate_Hz);
  }
  return length;
}

}  // namespace

FilmEnd film_end(const std::string& path) {
  FileBytes file(path);
  return end_of(file);
}

FileLength file_length(const std::string& path) {
  FileBytes file(path);
  const std::string head = file.read(0, 12);
  FileLength length;
  if (has_at(head, 0, "fLaC")) {
    length = length_of_flac(file);
  } else if (has_at(head, 0, "RIFF") && has_at(head, 8, "WAVE")) {
    length = length_of_wav(file);
  } else {
    length.is_cut_off = end_of(file) == FilmEnd::kCutOff;
  }
  return length;
}

}  // namespace spidar
