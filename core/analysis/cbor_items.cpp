// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "core/analysis/cbor_items.h"

#include <istream>
#include <nlohmann/json.hpp>

namespace spidar {
namespace {

using nlohmann::json;

/// Refuses what is no flat map where it begins: a tree as deep as a file wants needs as much stack.
class FlatMap final : public nlohmann::json_sax<json> {
 public:
  explicit FlatMap(CborItem& item) : item_(item) {}

  bool null() override { return false; }
  bool boolean(bool) override { return false; }
  bool number_float(double, const std::string&) override { return false; }
  bool start_array(size_t) override { return false; }
  bool end_array() override { return false; }
  bool parse_error(size_t, const std::string&, const json::exception&) override { return false; }
  bool start_object(size_t) override { return ++depth_ == 1; }
  bool end_object() override { return true; }

  bool number_integer(json::number_integer_t value) override {
    item_.numbers[key_] = value;
    return depth_ == 1;
  }
  bool number_unsigned(json::number_unsigned_t value) override {
    item_.numbers[key_] = static_cast<int64_t>(value);
    return depth_ == 1 && value <= INT64_MAX;
  }
  bool string(std::string& value) override {
    item_.texts[key_] = value;
    return depth_ == 1;
  }
  bool binary(json::binary_t& value) override {
    item_.binaries[key_] = std::move(value);
    return depth_ == 1;
  }
  bool key(std::string& value) override {
    key_ = value;
    return true;
  }

 private:
  CborItem& item_;
  std::string key_;
  int depth_ = 0;
};

}  // namespace

std::optional<int64_t> CborItem::number(const std::string& name) const {
  const auto found = numbers.find(name);
  if (found == numbers.end()) return std::nullopt;
  return found->second;
}

std::string CborItem::text(const std::string& name) const {
  const auto found = texts.find(name);
  return found == texts.end() ? "" : found->second;
}

std::string write_cbor(const CborItem& item) {
  json map = json::object();
  for (const auto& [name, value] : item.numbers) map[name] = value;
  for (const auto& [name, value] : item.texts) map[name] = value;
  for (const auto& [name, value] : item.binaries) map[name] = json::binary(value);
  std::string bytes;
  json::to_cbor(map, bytes);
  return bytes;
}

std::optional<CborItem> read_cbor(std::istream& file) {
  CborItem item;
  FlatMap map(item);
  if (!json::sax_parse(file, &map, json::input_format_t::cbor, false)) return std::nullopt;
  return item;
}

}  // namespace spidar
