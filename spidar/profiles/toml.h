// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The only file that includes toml++. The parser of toml++ 3.0 to 3.3 calls assert() when the name
/// of a table begins with a wrong character, as in "[~]"; compiled without assert(), the parser
/// assumes that no name does. A file must not end the program, so this header makes the parser
/// throw std::logic_error there. (For other mistakes, the parser throws toml::parse_error.) In
/// noexcept functions of toml++, the exception ends the program as assert() would, and GCC warns of
/// that.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

#include "spidar/profiles/profile.h"

#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(expression) \
  ((expression) ? void() : throw std::logic_error("a name has a wrong character"))

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wterminate"
#endif

#include <toml++/toml.h>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
#pragma pop_macro("NDEBUG")

namespace spidar {

/// Something that toml++ must not parse, and its line; 0: the text has nothing of that kind.
struct TomlTrap {
  int line = 0;
  const char* what = "";
};

/// Finds the first of two things. At some characters above ASCII that are neither in a string nor
/// in a comment, such as U+01BA, toml++ 3.3 has undefined behaviour. A name of very many parts
/// creates as many nested tables, which fill the stack.
inline TomlTrap trap_in_toml(std::string_view text) {
  constexpr int kMaxDots = 15;
  int dots = 0;
  const auto trap = [&](size_t at, const char* what) {
    const auto lines = std::count(text.begin(), text.begin() + static_cast<long>(at), '\n');
    return TomlTrap{1 + static_cast<int>(lines), what};
  };
  size_t i = text.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0;  // a byte order mark
  std::string_view end;                                    // the end of the string or comment
  while (i < text.size()) {
    if (!end.empty()) {
      const bool escapes = end[0] == '"' && text[i] == '\\';
      const bool ends = text.substr(i, end.size()) == end;
      i += escapes ? 2 : ends ? end.size() : 1;
      // A string in triple quotes may end with up to five quotes; the last three are its end.
      for (int n = 0; ends && end.size() == 3 && n < 2 && i < text.size() && text[i] == end[0];
           ++n) {
        ++i;
      }
      if (ends) end = {};
      continue;
    }
    if (static_cast<unsigned char>(text[i]) >= 0x80) {
      return trap(i, "a letter that is not ASCII must be in quotes");
    }
    // A name ends with its line at the latest. Numbers have one point each, too few to matter.
    if (text[i] == ',' || text[i] == '=' || text[i] == '\n') dots = 0;
    if (text[i] == '.' && ++dots > kMaxDots) return trap(i, "a name has more than 16 parts");
    for (const std::string_view begin : {"\"\"\"", "'''", "\"", "'", "#"}) {
      if (text.substr(i, begin.size()) != begin) continue;
      end = begin == "#" ? "\n" : begin;
      i += begin.size() - 1;
      break;
    }
    ++i;
  }
  return {};
}

inline toml::table parse_toml(const std::string& text, const std::string& path) {
  const auto fail = [&](const std::string& line, const std::string& why) -> toml::table {
    throw ProfileError(path + line + ": not TOML: " + why);
  };
  const TomlTrap trap = trap_in_toml(text);
  if (trap.line > 0) return fail(":" + std::to_string(trap.line), trap.what);
  try {
    return toml::parse(std::string_view(text), path);
  } catch (const toml::parse_error& error) {
    return fail(":" + std::to_string(error.source().begin.line), std::string(error.description()));
  } catch (const std::logic_error& error) {
    return fail("", error.what());
  }
}

}  // namespace spidar
