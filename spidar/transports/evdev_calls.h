// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// System calls for input devices.
#pragma once

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <linux/input.h>
#include <sys/ioctl.h>

namespace spidar {

/// Makes a call again that a signal has interrupted.
template <typename Call>
auto uninterrupted(const Call& call) noexcept {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

template <typename Argument>
int call_ioctl(int file, unsigned long request, Argument* argument) noexcept {
  return uninterrupted([&] { return ioctl(file, request, argument); });
}

template <size_t Bits>
using BitSet = std::array<uint8_t, Bits / 8 + 1>;

template <size_t N>
bool has(const std::array<uint8_t, N>& bits, unsigned bit) noexcept {
  return bits[bit / 8] >> bit % 8 & 1;
}

/// Codes of an event type that the device supports; none when it does not tell.
template <size_t Bits>
BitSet<Bits> codes(int file, unsigned type) noexcept {
  BitSet<Bits> bits{};
  if (call_ioctl(file, EVIOCGBIT(type, sizeof bits), bits.data()) < 0) bits.fill(0);
  return bits;
}

}  // namespace spidar
