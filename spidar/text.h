// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Text for people and from them: values, what devices say of themselves, misspelt words, options.
#pragma once

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace spidar {

/// The value as text; numbers have up to six digits, without trailing zeros.
template <typename T>
std::string as_text(const T& value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

[[gnu::format(printf, 1, 2)]] std::string formatted(const char* pattern, ...);

/// Returns the text with a question mark in place of each control character, which a terminal would
/// execute, each character that reverses the direction of writing, and each byte that is not UTF-8,
/// which neither JSON nor GStreamer accepts. Use this for texts that come from a device, such as
/// names and serial numbers.
std::string printable(std::string_view text);

/// The first 256 bytes of a file, which hold a description in sysfs; empty if the file cannot be
/// read.
std::string beginning_of(const std::string& path);
/// The first line of beginning_of(path), printable().
std::string first_line(const std::string& path);

/// Returns "; did you mean max-force?" for a word that is nearly one of `known`; else empty.
std::string meant(const std::string& word, const std::vector<std::string>& known);

/// The number from 1 to `largest` in an `option` "NAME=NUMBER", where `name` is "NAME="; 0 if
/// `option` has another form.
inline int option_value(const std::string& option, const std::string& name, int largest) {
  if (option.compare(0, name.size(), name) != 0) return 0;
  const std::string digits = option.substr(name.size());
  if (digits.empty() || digits.size() > 5) return 0;
  if (digits.find_first_not_of("0123456789") != std::string::npos) return 0;
  const int value = std::stoi(digits);
  return value <= largest ? value : 0;
}

}  // namespace spidar
