// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The other end of the wire: boards as programs that answer as the real ones are described.
#pragma once

#include <array>
#include <cstdint>

#include "core/grip/string_geometry.h"
#include "spidar/protocols/bytes.h"

namespace spidar {

/// What is connected to an emulated board.
class EmulatedMotors {
 public:
  virtual ~EmulatedMotors() = default;
  /// The D/A has these digits now.
  virtual void put_out(const std::array<int, kMaxStrings>& digits) noexcept = 0;
  /// Counts as the host is to see them.
  virtual std::array<int32_t, kMaxStrings> counts() noexcept = 0;
  /// 16 inputs; bits 4–7 are the rotary ID switch.
  virtual uint16_t inputs() noexcept { return 0; }
};

/// A board without its wire. One thread at a time.
class EmulatedBoard {
 public:
  virtual ~EmulatedBoard() = default;
  /// Bytes from the host: one packet, or any piece of a stream.
  virtual void receive(ByteView bytes) noexcept = 0;
  /// Writes the next reply that is due, returns its length; 0 when none is, or no room.
  virtual size_t reply(MutableBytes bytes) noexcept = 0;
};

}  // namespace spidar
