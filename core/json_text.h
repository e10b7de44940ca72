// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// JSON for other programs, in which names include units; and JSON from outside.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace spidar {

/// Whose members stay in the order in which they were added.
using Json = nlohmann::ordered_json;

/// On a single line, without its end, or indented by `indent`. File names are bytes and JSON is
/// UTF-8, so a byte that is not becomes U+FFFD. Numbers that are not finite are null.
inline std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// A vector of Eigen, whichever size it has.
template <typename Vector>
Json json_array(const Vector& values) {
  return std::vector<double>(values.begin(), values.end());
}

/// As it is read. Not ordered, which takes a time that grows with the square of the members.
using ReadJson = nlohmann::json;

/// Arrays and objects inside each other in JSON from outside, at most. HJIF has 12.
constexpr size_t kMostJsonDepth = 64;

/// All JSON that is not this program's own is read here: deeper or wrong JSON is refused before
/// anything is made of it that calls itself for each level. Of equal members the last one counts.
/// When it cannot be read, a value that is_discarded(), and `why` says why: "it is no JSON: …".
ReadJson parse_json(std::string_view text, std::string& why);

}  // namespace spidar
