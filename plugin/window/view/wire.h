// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Values as bytes, in the order and size that this machine has them in.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

namespace spidar {

/// A structure is written and read by one function, `template <typename Wire> void pass(Wire&,
/// T&)`, which calls wire(…) for each of its members. Nothing of the structure is changed when it
/// is written.
class WireWriter {
 public:
  static constexpr bool kReads = false;

  template <typename... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }
  void raw(const void* bytes, size_t count) {
    if (count == 0) return;
    const auto* const first = static_cast<const uint8_t*>(bytes);
    bytes_.insert(bytes_.end(), first, first + count);
  }
  /// `last`: the largest value of the enumeration.
  template <typename Enum>
  void choice(Enum& value, Enum /*last*/) {
    number(static_cast<int32_t>(value));
  }
  void fail() {}
  bool ok() const { return true; }
  std::vector<uint8_t>& bytes() { return bytes_; }

 private:
  template <typename Number>
  void number(Number value) {
    raw(&value, sizeof value);
  }
  void one(bool& value) { number(static_cast<uint8_t>(value ? 1 : 0)); }
  void one(std::string& text) {
    number(static_cast<uint32_t>(text.size()));
    raw(text.data(), text.size());
  }
  template <typename Value>
  void one(std::optional<Value>& value) {
    bool has = value.has_value();
    one(has);
    if (has) one(*value);
  }
  template <typename Value>
  void one(std::vector<Value>& values) {
    number(static_cast<uint32_t>(values.size()));
    for (Value& value : values) one(value);
  }
  template <int kRows, int kColumns, int kOptions>
  void one(Eigen::Matrix<double, kRows, kColumns, kOptions>& matrix) {
    raw(matrix.data(), sizeof(double) * static_cast<size_t>(matrix.size()));
  }
  template <typename Value>
  void one(Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      number(value);
    } else {
      pass(*this, value);
    }
  }

  std::vector<uint8_t> bytes_;
};

/// Reads what WireWriter wrote, and survives everything else: once a value does not fit into what
/// is left or into its own range, ok() is false, and the values are of no use.
class WireReader {
 public:
  static constexpr bool kReads = true;

  WireReader(const uint8_t* bytes, size_t count) : next_(bytes), left_(count) {}

  template <typename... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }
  void raw(void* bytes, size_t count) {
    if (!has(count)) return;
    if (count > 0) std::memcpy(bytes, next_, count);
    next_ += count;
    left_ -= count;
  }
  template <typename Enum>
  void choice(Enum& value, Enum last) {
    int32_t number = 0;
    one(number);
    if (number < 0 || number > static_cast<int32_t>(last)) return fail();
    value = static_cast<Enum>(number);
  }
  void fail() { ok_ = false; }
  bool ok() const { return ok_; }
  bool is_at_end() const { return left_ == 0; }

 private:
  bool has(size_t count) {
    if (count > left_) ok_ = false;
    return ok_;
  }
  void one(bool& value) {
    uint8_t byte = 0;
    one(byte);
    if (byte > 1) ok_ = false;
    value = byte == 1;
  }
  void one(std::string& text) {
    uint32_t count = 0;
    one(count);
    if (!has(count)) return;
    text.assign(reinterpret_cast<const char*>(next_), count);
    next_ += count;
    left_ -= count;
  }
  template <typename Value>
  void one(std::optional<Value>& value) {
    bool is_there = false;
    one(is_there);
    value.reset();
    if (ok_ && is_there) one(value.emplace());
  }
  template <typename Value>
  void one(std::vector<Value>& values) {
    uint32_t count = 0;
    one(count);
    values.clear();
    // Each value takes a byte or more, so what is reserved is bounded by what was sent.
    if (!has(count)) return;
    for (uint32_t i = 0; i < count && ok_; ++i) one(values.emplace_back());
  }
  template <int kRows, int kColumns, int kOptions>
  void one(Eigen::Matrix<double, kRows, kColumns, kOptions>& matrix) {
    raw(matrix.data(), sizeof(double) * static_cast<size_t>(matrix.size()));
  }
  template <typename Value>
  void one(Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      raw(&value, sizeof value);
    } else {
      pass(*this, value);
    }
  }

  const uint8_t* next_;
  size_t left_;
  bool ok_ = true;
};

}  // namespace spidar
