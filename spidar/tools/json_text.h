// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Data for other programs. Names include units.
#pragma once

#include <sstream>
#include <string>

#include <Eigen/Core>
#include <toml++/toml.h>

namespace spidar {

inline toml::array to_array(const Eigen::Ref<const Eigen::VectorXd>& values) {
  toml::array array;
  for (Eigen::Index i = 0; i < values.size(); ++i) array.push_back(values[i]);
  return array;
}

inline std::string json_text(const toml::table& table) {
  std::ostringstream out;
  out << toml::json_formatter(table) << '\n';
  return out.str();
}

/// Writes to a single line, for streams of data. Line breaks within strings are already escaped.
inline std::string json_line(const toml::table& table) {
  std::string line;
  bool indent = false;
  for (const char c : json_text(table)) {
    if (c == '\n') indent = true;
    if (c != '\n' && !(indent && c == ' ')) {
      line += c;
      indent = false;
    }
  }
  return line + "\n";
}

}  // namespace spidar
