// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An emulated Falcon in a hand, for device=sim:falcon.
#pragma once

#include "spidar/emulation/emulated_falcon.h"
#include "spidar/emulation/spring_hand.h"

namespace spidar {

/// With its firmware.
class HeldFalcon final : public EmulatedBoard {
 public:
  HeldFalcon() noexcept { memory_.loaded = true; }
  void receive(ByteView bytes) noexcept override { board_.receive(bytes); }
  size_t reply(MutableBytes bytes) noexcept override { return board_.reply(bytes); }
  bool control(const VendorRequest& request) noexcept override { return board_.control(request); }

 private:
  /// Every encoder has passed its mark, and no button is pressed.
  SpringHand hand_{0x70};
  FalconMemory memory_;
  EmulatedFalcon board_{hand_, memory_};
};

}  // namespace spidar
