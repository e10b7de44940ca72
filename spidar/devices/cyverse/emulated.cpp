// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/cyverse/emulated.h"

#include <array>
#include <optional>

namespace spidar::emulated {

void Sh4::receive(ByteView bytes) noexcept {
  CyverseDigits digits{};
  if (!sh4::decode_update(bytes, digits)) return;
  motors_->set_outputs(digits);
  const std::array<int32_t, kMaxStrings> counts = motors_->counts();
  sh4::Reading reading;
  reading.dac_echo = digits;
  for (size_t i = 0; i < sh4::kChannels; ++i) {
    reading.counter[i] = 0u - static_cast<uint32_t>(counts[i]);
  }
  reading.inputs = motors_->inputs();
  sh4::encode_reading(reading, packet_);
  due_ = true;
}

size_t Sh4::reply(MutableBytes bytes) noexcept {
  return copy_out(packet_, bytes, due_);
}

void Simple::receive(ByteView bytes) noexcept {
  CyverseDigits digits{};
  const std::optional<usb_simple::Command> command = usb_simple::decode_command(bytes, digits);
  if (!command) return;
  switch (*command) {
    case usb_simple::Command::kSetDac:
      motors_->set_outputs(digits);
      break;
    case usb_simple::Command::kLatchCounters: {
      const std::array<int32_t, kMaxStrings> counts = motors_->counts();
      CyverseReading reading;
      for (size_t i = 0; i < usb_simple::kChannels; ++i) {
        reading.counter[i] = static_cast<uint32_t>(counts[i]);
      }
      reading.inputs = motors_->inputs();
      usb_simple::encode_reading(reading, packet_);
      due_ = true;
      break;
    }
    case usb_simple::Command::kEncoderDirection:
      break;  // the emulated wiring already has the right direction
  }
}

size_t Simple::reply(MutableBytes bytes) noexcept {
  return copy_out(packet_, bytes, due_);
}

}  // namespace spidar::emulated
