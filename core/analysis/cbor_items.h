// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Flat maps in CBOR (RFC 8949).
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace spidar {

/// A map from names to integers, texts and byte strings.
struct CborItem {
  std::map<std::string, int64_t> numbers;
  std::map<std::string, std::string> texts;
  std::map<std::string, std::vector<uint8_t>> binaries;

  std::optional<int64_t> number(const std::string& name) const;
  /// Empty when there is none.
  std::string text(const std::string& name) const;
};

std::string write_cbor(const CborItem& item);

/// The next item of a sequence (RFC 8742). Nothing when it is not such a map, or not a whole one.
std::optional<CborItem> read_cbor(std::istream& file);

}  // namespace spidar
