// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>

#include "spidar/devices/force_feedback/packets.h"
#include "spidar/link/emulated_transport.h"

namespace spidar::emulated {

/// The emulated force-feedback device. Its digits are the sum of the playing effects: level to the
/// right, level upwards, and strength of the rumble. Its counts are the position of the stick to
/// the right and upwards, in units of ff::Position::kFull.
class ForceFeedback final : public Board {
 public:
  /// A stick with two axes, gain, autocentre and a capacity of sixteen effects.
  static ff::Description stick() noexcept;

  explicit ForceFeedback(std::shared_ptr<Motors> motors,
                         const ff::Description& description = stick()) noexcept
      : Board(std::move(motors)), description_(description) {}

  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;

 private:
  struct Slot {
    ff::Effect effect;
    bool used = false;
    bool plays = false;
  };

  void upload(const ff::Effect& effect) noexcept;
  void update_motors() noexcept;
  template <typename Structure>
  void answer(const Structure& structure) noexcept;

  const ff::Description description_;
  std::array<Slot, 16> slots_{};
  std::array<uint8_t, sizeof(ff::Description)> reply_{};
  size_t due_ = 0;
};

}  // namespace spidar::emulated
