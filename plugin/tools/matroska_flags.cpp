// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/matroska_flags.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace spidar {
namespace {

/// FlagDefault = 0, FlagEnabled = 0 and Language = "zxx": the identifier, the size (one byte), and
/// the value. Without a Language, Matroska's default is English.
constexpr char kFlags[] = {'\x88', '\x81', '\x00', '\xB9', '\x81', '\x00', '\x22',
                           '\xB5', '\x9C', '\x83', 'z',    'x',    'x'};
/// The description of the tracks is within the first bytes of the file, before the pictures.
constexpr size_t kHead = size_t{1} << 20;

/// The element Name with `content`, which the muxer terminates with a zero.
std::string name_element(const std::string& content) {
  std::string element = "\x53\x6E";
  element += static_cast<char>(0x80 | (content.size() + 1));
  return element + content + '\0';
}

}  // namespace

std::string name_with_room(const std::string& name) {
  return name + std::string(sizeof kFlags, ' ');
}

void clear_track_flags(const std::string& path, const std::string& name) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  std::string head(kHead, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(file.gcount()));
  file.clear();
  const std::string before = name_element(name_with_room(name));
  const size_t tracks = head.find("\x16\x54\xAE\x6B");
  const size_t at = tracks == std::string::npos ? tracks : head.find(before, tracks);
  if (at == std::string::npos) {
    throw std::runtime_error("there is no track \"" + name + "\" to be marked in the result");
  }
  const std::string after = name_element(name) + std::string(kFlags, sizeof kFlags);
  file.seekp(static_cast<std::streamoff>(at));
  file.write(after.data(), static_cast<std::streamsize>(after.size()));
  file.close();
  if (!file) throw std::runtime_error("the result cannot be written; the disk may be full");
}

}  // namespace spidar
