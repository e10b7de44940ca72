// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/emulation/emulated_inverse3.h"

#include <cmath>

namespace spidar {

void EmulatedInverse3::receive(ByteView bytes) noexcept {
  due_ = true;
  Eigen::Vector3d force_N;
  if (!inverse3::decode_force(bytes, state.id, force_N)) return;
  std::array<int, kMaxStrings> milli_N{};
  for (size_t i = 0; i < 3; ++i)
    milli_N[i] = static_cast<int>(std::lround(1000 * force_N[static_cast<int>(i)]));
  motors_.put_out(milli_N);
}

size_t EmulatedInverse3::reply(MutableBytes bytes) noexcept {
  if (!due_) return 0;
  due_ = false;
  const std::array<int32_t, kMaxStrings> counts = motors_.counts();
  for (size_t i = 0; i < 3; ++i) state.position_m[static_cast<int>(i)] = 1e-6 * counts[i];
  state.buttons = motors_.inputs();
  return inverse3::encode_state(state, bytes);
}

}  // namespace spidar
