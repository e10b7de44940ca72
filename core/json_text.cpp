// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/json_text.h"

#include <algorithm>

namespace spidar {
namespace {

/// Returns "line 2, column 7", both from 1, for the byte `at`.
std::string place(std::string_view text, size_t at) {
  const std::string_view before = text.substr(0, at);
  const size_t line_begin = before.rfind('\n') + 1;  // 0 when there is none
  return "line " + std::to_string(std::count(before.begin(), before.end(), '\n') + 1) +
         ", column " + std::to_string(at - line_begin + 1);
}

/// The bracket, outside of strings, that opens one level too many; npos when none does.
size_t first_too_deep(std::string_view text) {
  size_t depth = 0;
  bool is_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_string) {
      if (c == '\\') ++i;
      is_string = c != '"';
    } else if (c == '"') {
      is_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMaxJsonDepth) return i;
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return std::string_view::npos;
}

}  // namespace

ReadJson parse_json(std::string_view text, std::string& why) {
  const size_t deep = first_too_deep(text);
  if (deep != std::string_view::npos) {
    why = "its arrays and objects lie more than " + std::to_string(kMaxJsonDepth) +
          " deep in each other at " + place(text, deep);
    return ReadJson::value_t::discarded;
  }
  try {
    return ReadJson::parse(text.begin(), text.end());
  } catch (const ReadJson::parse_error& error) {
    // Bytes count from 1; at the end of the text, `byte` is the number of bytes plus one.
    const size_t at = std::max<size_t>(error.byte, 1) - 1;
    why = at >= text.size() ? "it is no JSON: it ends too early"
                            : "it is no JSON: " + place(text, at) + " is wrong";
  } catch (const ReadJson::exception&) {  // out_of_range is the only other exception
    why = "it has a number that is beyond 1.8e308";
  }
  return ReadJson::value_t::discarded;
}

}  // namespace spidar
