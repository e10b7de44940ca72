// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The emulated CyVerse boards.
#pragma once

#include <array>
#include <optional>

#include "spidar/devices/cyverse/packets.h"
#include "spidar/link/emulated_transport.h"

namespace spidar::emulated {

class Sh4 final : public Board {
 public:
  using Board::Board;
  void receive(ByteView bytes) noexcept override {
    sh4::Reading reading;
    if (!sh4::decode_update(bytes, reading.dac_echo)) return;
    motors_->set_outputs(reading.dac_echo);
    const std::array<int32_t, kMaxStrings> counts = motors_->counts();
    for (size_t i = 0; i < sh4::kChannels; ++i) {
      reading.counter[i] = 0u - static_cast<uint32_t>(counts[i]);
    }
    reading.inputs = motors_->inputs();
    sh4::encode_reading(reading, packet_);
    due_ = true;
  }
  size_t reply(MutableBytes bytes) noexcept override { return copy_out(packet_, bytes, due_); }

 private:
  sh4::Packet packet_{};
  bool due_ = false;
};

class Simple final : public Board {
 public:
  using Board::Board;
  void receive(ByteView bytes) noexcept override {
    CyverseDigits digits{};
    const std::optional<usb_simple::Command> command = usb_simple::decode_command(bytes, digits);
    if (command == usb_simple::Command::kSetDac) motors_->set_outputs(digits);
    // The emulated wiring already has the right direction of the encoders.
    if (command != usb_simple::Command::kLatchCounters) return;
    const std::array<int32_t, kMaxStrings> counts = motors_->counts();
    CyverseReading reading;
    for (size_t i = 0; i < usb_simple::kChannels; ++i) {
      reading.counter[i] = static_cast<uint32_t>(counts[i]);
    }
    reading.inputs = motors_->inputs();
    usb_simple::encode_reading(reading, packet_);
    due_ = true;
  }
  size_t reply(MutableBytes bytes) noexcept override { return copy_out(packet_, bytes, due_); }

 private:
  usb_simple::Packet packet_{};
  bool due_ = false;
};

}  // namespace spidar::emulated
