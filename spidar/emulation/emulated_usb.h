// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Emulated CyVerse boards and SPIDAR-mouse.
#pragma once

#include <array>

#include "spidar/emulation/emulated_board.h"
#include "spidar/protocols/sh4.h"
#include "spidar/protocols/spidar_mouse.h"
#include "spidar/protocols/usb_simple.h"

namespace spidar {

class EmulatedSh4 final : public EmulatedBoard {
 public:
  explicit EmulatedSh4(EmulatedMotors& motors) : motors_(motors) {}
  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;

 private:
  EmulatedMotors& motors_;
  sh4::Packet packet_{};
  bool due_ = false;
};

class EmulatedSimple final : public EmulatedBoard {
 public:
  explicit EmulatedSimple(EmulatedMotors& motors) : motors_(motors) {}
  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;

 private:
  EmulatedMotors& motors_;
  usb_simple::Packet packet_{};
  bool due_ = false;
};

/// Its digits are the force in millinewtons, x and y.
class EmulatedMouse final : public EmulatedBoard {
 public:
  explicit EmulatedMouse(EmulatedMotors& motors) : motors_(motors) {}
  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;

 private:
  EmulatedMotors& motors_;
  bool due_ = false;
  bool started_ = false;
};

}  // namespace spidar
