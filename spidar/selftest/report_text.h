// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Numbers for people, and data for other programs, in which names include units.
#pragma once

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace spidar {

/// As std::printf() writes it.
[[gnu::format(printf, 1, 2)]] inline std::string formatted(const char* pattern, ...) {
  va_list values, counted;
  va_start(values, pattern);
  va_copy(counted, values);
  const int length = std::vsnprintf(nullptr, 0, pattern, counted);
  va_end(counted);
  std::string text(static_cast<size_t>(std::max(length, 0)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, pattern, values);
  va_end(values);
  return text;
}

using Json = nlohmann::ordered_json;

inline Json to_json(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return std::vector<double>(values.data(), values.data() + values.size());
}

/// Indented, or with `indent` −1 on a single line. File names are bytes, and JSON is UTF-8. Numbers
/// that are not finite are null.
inline std::string json_text(const Json& json, int indent = 2) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace spidar
