// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/emulation/emulated_inverse3.h"

#include "spidar/emulation/spring_hand.h"

namespace spidar {

void EmulatedInverse3::receive(ByteView bytes) noexcept {
  due_ = true;
  Eigen::Vector3d force_N;
  if (inverse3::decode_force(bytes, state.id, force_N)) put_out_N(motors_, force_N);
}

size_t EmulatedInverse3::reply(MutableBytes bytes) noexcept {
  if (!due_) return 0;
  due_ = false;
  state.position_m = position_m(motors_);
  state.buttons = motors_.inputs();
  return inverse3::encode_state(state, bytes);
}

}  // namespace spidar
