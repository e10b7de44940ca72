// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spidar {

/// JSON to write: members stay in the order in which they were added.
using Json = nlohmann::ordered_json;

/// Serializes `json`: to a single line without a newline, or with `indent` spaces per level if
/// `indent` is not negative. A file name may be invalid UTF-8; each invalid byte becomes U+FFFD.
/// Numbers that are not finite become null.
inline std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// An Eigen vector of any size as a JSON array.
template <typename Vector>
Json json_array(const Vector& values) {
  return std::vector<double>(values.begin(), values.end());
}

/// Untrusted JSON. Members are sorted by name: to keep their order would take quadratic time.
using ReadJson = nlohmann::json;

/// The maximum nesting depth of untrusted JSON. HJIF needs 12.
constexpr size_t kMaxJsonDepth = 64;

/// Parses untrusted JSON. Rejects JSON nested deeper than kMaxJsonDepth before any recursive code
/// runs. Of members with the same name, the last one is kept. On an error, returns a value that
/// is_discarded() and sets `why` to the reason: "it is no JSON: …".
ReadJson parse_json(std::string_view text, std::string& why);

}  // namespace spidar
