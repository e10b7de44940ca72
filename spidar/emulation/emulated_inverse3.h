// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Haply's Inverse Service with one Inverse3, without its socket.
#pragma once

#include "spidar/emulation/emulated_board.h"
#include "spidar/protocols/inverse3.h"

namespace spidar {

/// Its digits are the force in millinewtons, its counts the position in micrometres: to the right,
/// up, towards the viewer. The inputs are the buttons.
class EmulatedInverse3 final : public EmulatedBoard {
 public:
  explicit EmulatedInverse3(EmulatedMotors& motors,
                            inverse3::Version version = inverse3::Version::k35)
      : motors_(motors) {
    state.id = "049D";
    state.version = version;
  }

  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;

  inverse3::State state;  ///< what it reports, except for position and buttons

 private:
  EmulatedMotors& motors_;
  bool due_ = false;
};

}  // namespace spidar
