// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The emulated SPIDAR-mouse.
#pragma once

#include <array>
#include <cmath>

#include "spidar/devices/mouse/packets.h"
#include "spidar/link/emulated_transport.h"

namespace spidar::emulated {

/// Its digits are the force in millinewtons, x and y.
class Mouse final : public Board {
 public:
  using Board::Board;
  void receive(ByteView bytes) noexcept override {
    mouse::Command command{};
    Eigen::Vector2d force_N;
    if (!mouse::decode_command(bytes, command, force_N)) return;
    if (command == mouse::Command::kQuery) due_ = true;
    if (command == mouse::Command::kStart) started_ = true;
    if (command == mouse::Command::kStop) started_ = false;
    std::array<int, kMaxStrings> milli_N{};
    if (command == mouse::Command::kForce && started_) {
      milli_N[0] = static_cast<int>(std::lround(1000 * force_N.x()));
      milli_N[1] = static_cast<int>(std::lround(1000 * force_N.y()));
    }
    if (command == mouse::Command::kForce || command == mouse::Command::kStop) {
      motors_->put_out(milli_N);
    }
  }
  size_t reply(MutableBytes bytes) noexcept override {
    mouse::Report report;
    mouse::encode_state(report);
    return copy_out(report, bytes, due_);
  }

 private:
  bool due_ = false;
  bool started_ = false;
};

}  // namespace spidar::emulated
