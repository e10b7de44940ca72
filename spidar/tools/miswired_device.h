// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A device that is wired wrongly.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "spidar/device.h"

namespace spidar {

/// What is connected to each channel of the board.
struct Miswiring {
  struct Channel {
    int motor = 0;         ///< the string whose motor it is
    int encoder = 0;       ///< the string whose encoder it is
    int motor_sign = 1;    ///< −1: wires reversed; 0: wires cut
    int encoder_sign = 1;  ///< likewise
  };
  std::array<Channel, kMaxStrings> channel{};

  /// Whether everything is connected as it should be.
  Miswiring();
};

/// `text` lists faults separated by semicolons; channels count from zero: `swap-motors:I,J`,
/// `swap-encoders:I,J`, `swap-strings:I,J` (both), `reverse-motor:I`, `reverse-encoder:I`,
/// `cut-motor:I`, `cut-encoder:I`. Throws std::invalid_argument that says what is wrong.
Miswiring parse_miswiring(const std::string& text, int strings);

/// Puts `device` behind that wiring.
std::unique_ptr<Device> make_miswired(std::unique_ptr<Device> device, const Miswiring& wiring);

}  // namespace spidar
