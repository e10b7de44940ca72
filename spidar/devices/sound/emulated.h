// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "spidar/devices/sound/packets.h"
#include "spidar/link/emulated_transport.h"

namespace spidar::emulated {

/// The emulated sound card. Its digits are the levels of the channels in thousandths.
class Sound final : public Board {
 public:
  using Board::Board;

  void receive(ByteView bytes) noexcept override {
    sound::Levels levels;
    if (bytes.size != sizeof levels) return;
    std::memcpy(&levels, bytes.data, sizeof levels);
    std::array<int, kMaxStrings> digits{};
    for (size_t i = 0; i < sound::kMaxChannels; ++i) {
      digits[i] = static_cast<int>(std::lround(1000 * levels.level[i]));
    }
    motors_->set_outputs(digits);
    due_ = true;
  }
  size_t reply(MutableBytes bytes) noexcept override {
    if (!std::exchange(due_, false) || bytes.size < sizeof state) return 0;
    std::memcpy(bytes.data, &state, sizeof state);
    return sizeof state;
  }

  sound::State state{30'000'000};  ///< what the card reports

 private:
  bool due_ = false;
};

}  // namespace spidar::emulated
