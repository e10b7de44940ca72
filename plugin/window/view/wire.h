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

/// Writes values, or reads what was written. A structure is passed by one function, `template
/// <typename Wire> void pass(Wire&, T&)`, which calls wire(…) for each of its members. Nothing of
/// it is changed when it is written.
///
/// Reading survives all other bytes: once a value does not fit into what is left or into its own
/// range, ok() is false, and the values are of no use.
template <bool kIsReader>
class Wire {
 public:
  static constexpr bool kReads = kIsReader;

  Wire() = default;
  Wire(const uint8_t* bytes, size_t count) : next_(bytes), left_(count) {}

  template <typename... Values>
  void operator()(Values&... values) {
    (one(values), ...);
  }
  /// `last`: the largest value of the enumeration.
  template <typename Enum>
  void choice(Enum& value, Enum last) {
    auto number = static_cast<int32_t>(value);
    one(number);
    if (number < 0 || number > static_cast<int32_t>(last)) return fail();
    if constexpr (kReads) value = static_cast<Enum>(number);
  }
  void fail() { ok_ = false; }
  bool ok() const { return ok_; }
  bool is_at_end() const { return left_ == 0; }
  std::vector<uint8_t>& bytes() { return written_; }

 private:
  bool has(size_t count) {
    if (count > left_) fail();
    return ok_;
  }
  void raw(void* bytes, size_t count) {
    if (count == 0) return;
    if constexpr (kReads) {
      if (!has(count)) return;
      std::memcpy(bytes, next_, count);
      next_ += count;
      left_ -= count;
    } else {
      const auto* const first = static_cast<const uint8_t*>(bytes);
      written_.insert(written_.end(), first, first + count);
    }
  }
  /// How many values follow. Each takes a byte or more, so that what is reserved when it is read is
  /// bounded by what was sent.
  size_t count_of(size_t size) {
    auto count = static_cast<uint32_t>(size);
    one(count);
    return kReads && !has(count) ? 0 : count;
  }
  void one(bool& value) {
    auto byte = static_cast<uint8_t>(value ? 1 : 0);
    one(byte);
    if (byte > 1) return fail();
    if constexpr (kReads) value = byte == 1;
  }
  void one(std::string& text) {
    const size_t count = count_of(text.size());
    if constexpr (kReads) text.resize(count);
    raw(text.data(), count);
  }
  template <typename Value>
  void one(std::optional<Value>& value) {
    bool is_there = value.has_value();
    one(is_there);
    if (kReads) value.reset();
    if (!ok_ || !is_there) return;
    if (kReads) value.emplace();
    one(*value);
  }
  template <typename Value>
  void one(std::vector<Value>& values) {
    const size_t count = count_of(values.size());
    if (kReads) values.clear();
    for (size_t i = 0; i < count && ok_; ++i) {
      if (kReads) values.emplace_back();
      one(values[i]);
    }
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

  std::vector<uint8_t> written_;
  const uint8_t* next_ = nullptr;
  size_t left_ = 0;
  bool ok_ = true;
};

using WireWriter = Wire<false>;
using WireReader = Wire<true>;

}  // namespace spidar
