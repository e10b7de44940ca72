// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

namespace spidar {

/// A number as text for programs and files, the same in every locale: the shortest text that is
/// read back as the same number, 1e-09 for small ones. Allocates nothing and always fits.
class NumberText {
 public:
  template <typename Number>
  explicit NumberText(Number number) noexcept {
    static_assert(std::is_arithmetic_v<Number> && sizeof number <= sizeof(uint64_t));
    const auto [end, error] = std::to_chars(text_.data(), text_.data() + text_.size(), number);
    if (error == std::errc()) length_ = static_cast<size_t>(end - text_.data());
  }
  operator std::string_view() const noexcept { return {text_.data(), length_}; }

 private:
  /// The length of "-2.2250738585072014e-308", the longest double; integers of 64 bits are shorter.
  static constexpr size_t kLongest = 24;

  std::array<char, kLongest> text_{};
  size_t length_ = 0;
};

/// Parses the whole text as one finite number; returns nothing if it is anything else.
inline std::optional<double> number_of(std::string_view text) noexcept {
  double value = 0;
  const char* const text_end = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), text_end, value);
  if (error != std::errc() || end != text_end || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace spidar
