// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// JSON for other programs, in which names include units.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
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

}  // namespace spidar
