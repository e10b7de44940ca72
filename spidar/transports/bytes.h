// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Views of byte strings, and little-endian numbers in them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spidar {

struct ByteView {
  const uint8_t* data = nullptr;
  size_t size = 0;

  ByteView() = default;
  ByteView(const uint8_t* bytes, size_t count) : data(bytes), size(count) {}
  template <size_t N>
  ByteView(const std::array<uint8_t, N>& bytes) : data(bytes.data()), size(N) {}

  /// Returns zero beyond the end.
  uint8_t u8(size_t at) const noexcept { return at < size ? data[at] : uint8_t{0}; }
  uint16_t u16(size_t at) const noexcept { return static_cast<uint16_t>(u8(at) | u8(at + 1) << 8); }
  uint32_t u24(size_t at) const noexcept {
    return static_cast<uint32_t>(u16(at)) | static_cast<uint32_t>(u8(at + 2)) << 16;
  }
  uint32_t u32(size_t at) const noexcept {
    return static_cast<uint32_t>(u16(at)) | static_cast<uint32_t>(u16(at + 2)) << 16;
  }
};

/// A view of bytes to write. Writes beyond the end are ignored.
struct MutableBytes {
  uint8_t* data = nullptr;
  size_t size = 0;

  MutableBytes() = default;
  MutableBytes(uint8_t* bytes, size_t count) : data(bytes), size(count) {}
  template <size_t N>
  MutableBytes(std::array<uint8_t, N>& bytes) : data(bytes.data()), size(N) {}

  operator ByteView() const noexcept { return {data, size}; }

  void put_u8(size_t at, uint8_t value) const noexcept {
    if (at < size) data[at] = value;
  }
  void put_u16(size_t at, uint16_t value) const noexcept {
    put_u8(at, static_cast<uint8_t>(value & 0xFF));
    put_u8(at + 1, static_cast<uint8_t>(value >> 8));
  }
  void put_u24(size_t at, uint32_t value) const noexcept {
    put_u16(at, static_cast<uint16_t>(value & 0xFFFF));
    put_u8(at + 2, static_cast<uint8_t>(value >> 16 & 0xFF));
  }
  void put_u32(size_t at, uint32_t value) const noexcept {
    put_u16(at, static_cast<uint16_t>(value & 0xFFFF));
    put_u16(at + 2, static_cast<uint16_t>(value >> 16));
  }
  void fill(uint8_t value) const noexcept {
    for (size_t i = 0; i < size; ++i) data[i] = value;
  }
};

}  // namespace spidar
