// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Between the interface in C and the one in C++: types of the same layout, and exceptions as
/// errors.
#pragma once

#include <algorithm>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <gst-spidar/c-api.h>

namespace gst_spidar {
inline namespace v0 {

/// The same data as a type of the other language, whose members are the same in the same order.
/// Unlike a cast, it may be given an enum of C that has none of its values.
template <typename To, typename From>
To same(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  static_assert(std::is_trivially_copyable_v<To> && std::is_trivially_copyable_v<From>);
  To to;
  std::memcpy(static_cast<void*>(&to), &from, sizeof to);
  return to;
}

/// Writes `text` as snprintf() does, and not half a character of UTF-8. Returns its length.
inline size_t write_text(const std::string& text, char* to, size_t size) noexcept {
  if (size == 0) return text.size();
  size_t length = std::min(size - 1, text.size());
  const auto continues = [&](size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
  };
  while (length > 0 && length < text.size() && continues(length)) --length;
  std::memcpy(to, text.data(), length);
  to[length] = '\0';
  return text.size();
}

inline void set_error(GstSpidarError* error, GstSpidarErrorKind kind,
                      const std::string& message) noexcept {
  if (error == nullptr) return;
  error->kind = kind;
  write_text(message, error->message, sizeof error->message);
}

/// What `call` returns, or `failed` with the error when it throws.
template <typename Result, typename Call>
Result guarded(GstSpidarError* error, Result failed, const Call& call) noexcept {
  set_error(error, GST_SPIDAR_OK, {});
  try {
    return call();
  } catch (const std::invalid_argument& wrong) {
    set_error(error, GST_SPIDAR_ERROR_ARGUMENT, wrong.what());
  } catch (const std::exception& other) {
    set_error(error, GST_SPIDAR_ERROR_FAILED, other.what());
  }
  return failed;
}

/// Whether `call` has not thrown.
template <typename Call>
bool done(GstSpidarError* error, const Call& call) noexcept {
  return guarded(error, false, [&] {
    call();
    return true;
  });
}

}  // namespace v0
}  // namespace gst_spidar
