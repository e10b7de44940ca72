// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "spidar/devices/force_feedback/packets.h"
#include "spidar/link/emulated_transport.h"

namespace spidar::emulated {

/// The emulated force-feedback device. Its digits are the sum of the playing effects: level to the
/// right, level upwards, and strength of the rumble. Its counts are the position of the stick to
/// the right and upwards, in units of ff::Position::kFull.
class ForceFeedback final : public Board {
 public:
  /// A stick with two axes, gain, autocentre and a capacity of sixteen effects.
  static ff::Description stick() noexcept {
    ff::Description description;
    description.constant = description.rumble = description.gain = description.autocentre = 1;
    description.effects = 16;
    description.axes = 2;
    constexpr char kName[] = "emulated stick";
    std::copy(std::begin(kName), std::end(kName), description.name.begin());
    return description;
  }

  explicit ForceFeedback(std::shared_ptr<Motors> motors,
                         const ff::Description& description = stick()) noexcept
      : Board(std::move(motors)), description_(description) {}

  void receive(ByteView bytes) noexcept override {
    if (bytes.size == ff::kDescribeSize) {
      answer(description_);
    } else if (bytes.size == ff::kPositionSize) {
      const std::array<int32_t, kMaxStrings> counts = motors_->counts();
      answer(ff::Position{static_cast<int16_t>(counts[0]), static_cast<int16_t>(counts[1])});
    } else if (const auto effect = ff::decode_effect(bytes)) {
      upload(*effect);
    } else if (const auto event = ff::decode_event(bytes)) {
      if (event->code >= slots_.size()) return;  // the code is gain or autocentre, not an effect
      slots_[event->code].plays = event->value > 0;
      update_motors();
    }
  }
  size_t reply(MutableBytes bytes) noexcept override {
    const size_t length = std::min(bytes.size, due_);
    std::copy_n(reply_.begin(), length, bytes.data);
    due_ = 0;
    return length;
  }

 private:
  struct Slot {
    ff::Effect effect;
    bool used = false;
    bool plays = false;
  };

  void upload(const ff::Effect& effect) noexcept {
    const size_t capacity = std::min<size_t>(slots_.size(), description_.effects);
    size_t at = static_cast<size_t>(effect.number);
    if (effect.number == ff::kNewEffect) {
      at = 0;
      while (at < capacity && slots_[at].used) ++at;
    }
    if (at >= capacity) return;
    slots_[at].effect = effect;
    slots_[at].used = true;
    answer(static_cast<int16_t>(at));
    update_motors();
  }
  void update_motors() noexcept {
    double right = 0, up = 0, rumble = 0;
    for (const Slot& slot : slots_) {
      if (!slot.plays) continue;
      right += slot.effect.right;
      up += slot.effect.up;
      rumble += slot.effect.rumble;
    }
    motors_->set_outputs({static_cast<int>(std::lround(right * ff::kFullLevel)),
                          static_cast<int>(std::lround(up * ff::kFullLevel)),
                          static_cast<int>(std::lround(rumble * ff::kFullStrength))});
  }
  template <typename Structure>
  void answer(const Structure& structure) noexcept {
    static_assert(sizeof structure <= sizeof(ff::Description));
    std::memcpy(reply_.data(), &structure, sizeof structure);
    due_ = sizeof structure;
  }

  const ff::Description description_;
  std::array<Slot, 16> slots_{};
  std::array<uint8_t, sizeof(ff::Description)> reply_{};
  size_t due_ = 0;
};

}  // namespace spidar::emulated
