// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/films/file_end.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "plugin/films/file_bytes.h"
#include "plugin/films/flac_frames.h"

namespace spidar {
namespace {

/// What writers that cannot seek back leave as a size of 32 bits: the largest of either sign, less
/// some of the head (sox writes 0x7ffff000 less a remainder), or no bit but the first.
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

/// The types of boxes that are not inside others.
bool is_box(const std::string& type) {
  constexpr const char* kTypes[] = {"emsg", "free", "ftyp", "mdat", "meta", "mfra",
                                    "moof", "moov", "pdin", "pnot", "prft", "sidx",
                                    "skip", "ssix", "styp", "udta", "uuid", "wide"};
  return std::any_of(std::begin(kTypes), std::end(kTypes),
                     [&type](const char* one) { return type == one; });
}

/// ISO/IEC 14496-12. What follows a film that is complete, and is no box of it, has been
/// appended.
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
    if (length < 8) return FilmEnd::kUnknown;  // 0: it goes on to the end
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
  if (page == std::string::npos) return FilmEnd::kUnknown;  // so much has been appended
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

/// Of a WAV file: its chunk "data". wavparse plays what is there.
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

/// What trims a file copies whole frames, and leaves the length in its head as it was: only where a
/// frame is incomplete is it cut off.
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
