// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The emulated Haply Inverse3, with the maker's service.
#pragma once

#include "spidar/devices/inverse3/packets.h"
#include "spidar/link/emulated_transport.h"
#include "spidar/link/spring_hand.h"

namespace spidar::emulated {

/// Its digits are the force in millinewtons, its counts the position in micrometres: to the right,
/// up, towards the viewer. The inputs are the buttons.
class Inverse3 final : public Board {
 public:
  explicit Inverse3(std::shared_ptr<Motors> motors,
                    inverse3::Version version = inverse3::Version::k35)
      : Board(std::move(motors)) {
    state.id = "049D";
    state.version = version;
  }

  void receive(ByteView bytes) noexcept override {
    due_ = true;
    Eigen::Vector3d force_N;
    if (inverse3::decode_force(bytes, state.id, force_N)) put_out_N(*motors_, force_N);
  }
  size_t reply(MutableBytes bytes) noexcept override {
    if (!due_) return 0;
    due_ = false;
    state.position_m = position_m(*motors_);
    state.buttons = motors_->inputs();
    return inverse3::encode_state(state, bytes);
  }

  inverse3::State state;  ///< what it reports, except for position and buttons

 private:
  bool due_ = false;
};

}  // namespace spidar::emulated
