// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/films/flac_frames.h"

#include <string>

namespace spidar {
namespace {

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

/// Where the frame ends that begins there: its checksum comes last, so that it becomes 0. Nothing
/// when it is not whole.
std::optional<size_t> end_of_frame(const std::string& bytes, size_t from) {
  unsigned crc = 0;
  for (size_t i = from; i < bytes.size(); ++i) {
    crc ^= static_cast<unsigned>(static_cast<uint8_t>(bytes[i])) << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1U ^ (crc & 0x8000U ? 0x8005U : 0)) & 0xffffU;
    if (crc == 0 && i > from) return i + 1;
  }
  return std::nullopt;
}

/// Whether another frame begins there, of which there may be a single byte; what taggers append
/// does not begin like one.
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

}  // namespace

FlacLength flac_length(FileBytes& file) {
  FlacLength length;
  uint64_t first = 0;
  const std::optional<StreamInfo> info = read_head(file, first);
  if (!info) return length;
  length.rate_Hz = info->rate_Hz;
  length.promised = info->samples;
  // More than a frame of 65535 samples of 32 bits in eight channels is rare; what was appended is
  // shorter.
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

}  // namespace spidar
