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

/// The text of `json`: on a single line without a line end, or indented by `indent` if that is not
/// negative. File names are bytes and JSON is UTF-8, so an invalid byte becomes U+FFFD. Numbers
/// that are not finite become null.
inline std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// An Eigen vector of any size as a JSON array.
template <typename Vector>
Json json_array(const Vector& values) {
  return std::vector<double>(values.begin(), values.end());
}

/// JSON from outside. Its members are sorted by name, because keeping their order would take a time
/// that grows with the square of their number.
using ReadJson = nlohmann::json;

/// The greatest depth of nested arrays and objects in JSON from outside. HJIF has 12.
constexpr size_t kMaxJsonDepth = 64;

/// Parses all JSON from outside. Refuses deeper JSON before any code recurses into its levels. The
/// last of several members with one name counts. On an error returns a value that is_discarded(),
/// and `why` explains it: "it is no JSON: …".
ReadJson parse_json(std::string_view text, std::string& why);

}  // namespace spidar
