// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A device whose plugs are in the wrong sockets.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "core/api.h"
#include "spidar/device.h"

namespace spidar {

/// What each channel of the board is connected to.
struct Miswiring {
  struct Channel {
    int motor = 0;         ///< whose motor
    int encoder = 0;       ///< whose encoder
    int motor_sign = 1;    ///< −1: wires reversed; 0: cut
    int encoder_sign = 1;  ///< as that
  };
  std::array<Channel, kMaxStrings> channel{};

  /// All is as it should be.
  SPIDAR_API Miswiring();
};

/// `text`: faults separated by semicolons, channels from zero: `swap-motors:I,J`,
/// `swap-encoders:I,J`, `swap-strings:I,J` (both), `reverse-motor:I`, `reverse-encoder:I`,
/// `cut-motor:I`, `cut-encoder:I`. Throws std::invalid_argument that says what is wrong.
SPIDAR_API Miswiring parse_miswiring(const std::string& text, int strings);

/// `device` behind that wiring.
SPIDAR_API std::unique_ptr<Device> make_miswired(std::unique_ptr<Device> device,
                                                 const Miswiring& wiring);

}  // namespace spidar
