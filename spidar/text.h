// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Text for people: values, what devices say of themselves, words that are misspelt.
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

/// As std::printf() writes it.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* pattern, ...);

/// The text with a question mark for each control character, which a terminal would obey, for each
/// character that reverses the direction of writing, and for each byte that is not UTF-8, which
/// neither JSON nor GStreamer takes. To be used where a name, a serial number or the like comes
/// from a device.
std::string printable(std::string_view text);

/// "; did you mean max-force?" for a word that is nearly one of `known`; else empty.
std::string meant(const std::string& word, const std::vector<std::string>& known);

}  // namespace spidar
