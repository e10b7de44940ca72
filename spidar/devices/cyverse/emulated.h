// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The emulated CyVerse boards.
#pragma once

#include "spidar/devices/cyverse/packets.h"
#include "spidar/link/emulated_transport.h"

namespace spidar::emulated {

class Sh4 final : public Board {
 public:
  using Board::Board;
  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;

 private:
  sh4::Packet packet_{};
  bool due_ = false;
};

class Simple final : public Board {
 public:
  using Board::Board;
  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;

 private:
  usb_simple::Packet packet_{};
  bool due_ = false;
};

}  // namespace spidar::emulated
