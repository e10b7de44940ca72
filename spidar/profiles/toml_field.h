// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A value of a TOML file that knows where it stands, so that whatever is wrong with it is reported
/// with file, line and name.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include <toml++/toml.h>

#include "spidar/as_text.h"
#include "spidar/profiles/profile.h"

namespace spidar {

/// Every accessor throws ProfileError when the value is not what is asked for. Refers to the parsed
/// document and to `file`, which outlive it.
class TomlField {
 public:
  using Names = std::initializer_list<std::string_view>;

  TomlField(const std::string& file, const toml::node& node, std::string name = "")
      : file_(&file), node_(&node), name_(std::move(name)) {}

  /// "file:line: name: what"
  [[noreturn]] void fail(const std::string& what) const {
    fail(*file_, node_->source().begin.line, name_, what);
  }

  [[noreturn]] static void fail(const std::string& file, toml::source_index line,
                                const std::string& name, const std::string& what) {
    throw ProfileError(file + ":" + std::to_string(line) + ": " +
                       (name.empty() ? "" : name + ": ") + what);
  }

  // --- tables

  bool has(std::string_view key) const { return table().contains(key); }

  TomlField operator[](std::string_view key) const {
    const toml::node* node = table().get(key);
    if (!node) TomlField(*file_, *node_, member(key)).fail("missing");
    return {*file_, *node, member(key)};
  }

  void allow_only(Names keys) const {
    for (const auto& [key, node] : table())
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
        fail(*file_, key.source().begin.line, member(key.str()),
             "unknown key; known here are " + listed(keys));
  }

  // --- arrays

  bool is_array() const { return node_->is_array(); }

  size_t size() const { return array().size(); }

  /// `i` < size().
  TomlField operator[](size_t i) const {
    return {*file_, array()[i], name_ + "[" + std::to_string(i) + "]"};
  }

  // --- values

  std::string string() const {
    if (!node_->is_string()) wrong_type("a string");
    return node_->as_string()->get();
  }

  std::string one_of(Names allowed) const {
    const std::string value = string();
    if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
      fail("is \"" + value + "\", must be one of " + listed(allowed));
    return value;
  }

  int integer(int low, int high) const {
    const std::string range = "an integer from " + as_text(low) + " to " + as_text(high);
    if (!node_->is_integer()) wrong_type(range);
    const int64_t value = node_->as_integer()->get();
    if (value < low || value > high) fail("is " + as_text(value) + ", must be " + range);
    return static_cast<int>(value);
  }

  /// Finite; integers count as numbers.
  double number() const {
    if (!node_->is_number()) wrong_type("a number");
    const double value = node_->is_integer() ? static_cast<double>(node_->as_integer()->get())
                                             : node_->as_floating_point()->get();
    if (!std::isfinite(value)) fail("is " + as_text(value) + ", must be finite");
    return value;
  }

  double positive() const {
    const double value = number();
    if (!(value > 0)) fail("is " + as_text(value) + ", must be above zero");
    return value;
  }

 private:
  [[noreturn]] void wrong_type(const std::string& right) const {
    fail("is " + as_text(node_->type()) + ", must be " + right);
  }

  const toml::table& table() const {
    if (!node_->is_table()) wrong_type("a table");
    return *node_->as_table();
  }

  const toml::array& array() const {
    if (!node_->is_array()) wrong_type("an array");
    return *node_->as_array();
  }

  std::string member(std::string_view key) const {
    return (name_.empty() ? "" : name_ + ".") + std::string(key);
  }

  static std::string listed(Names names) {
    std::string text;
    for (const std::string_view name : names) text.append(text.empty() ? "" : ", ").append(name);
    return text;
  }

  const std::string* file_;
  const toml::node* node_;
  std::string name_;
};

}  // namespace spidar
