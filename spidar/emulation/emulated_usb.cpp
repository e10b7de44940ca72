// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The CyVerse boards and the SPIDAR-mouse.
#include "spidar/emulation/emulated_usb.h"

#include <algorithm>
#include <cmath>

namespace spidar {
namespace {

template <size_t N>
std::array<int, kMaxStrings> as_ints(const std::array<uint16_t, N>& digits) noexcept {
  std::array<int, kMaxStrings> ints{};
  std::copy(digits.begin(), digits.end(), ints.begin());
  return ints;
}

size_t copy_out(ByteView packet, MutableBytes bytes, bool& due) noexcept {
  if (!due || bytes.size < packet.size) return 0;
  due = false;
  std::copy_n(packet.data, packet.size, bytes.data);
  return packet.size;
}

}  // namespace

void EmulatedSh4::receive(ByteView bytes) noexcept {
  sh4::DacDigits digits{};
  if (!sh4::decode_update(bytes, digits)) return;
  motors_.put_out(as_ints(digits));
  const std::array<int32_t, kMaxStrings> counts = motors_.counts();
  sh4::Reading reading;
  reading.dac_echo = digits;
  for (size_t i = 0; i < sh4::kChannels; ++i)
    reading.counter[i] = static_cast<uint16_t>(0u - static_cast<uint32_t>(counts[i]));
  reading.inputs = motors_.inputs();
  sh4::encode_reading(reading, packet_);
  due_ = true;
}

size_t EmulatedSh4::reply(MutableBytes bytes) noexcept {
  return copy_out(packet_, bytes, due_);
}

void EmulatedSimple::receive(ByteView bytes) noexcept {
  usb_simple::HostPacket said;
  if (!usb_simple::decode_command(bytes, said)) return;
  switch (said.command) {
    case usb_simple::Command::kSetDac:
      motors_.put_out(as_ints(said.digits));
      break;
    case usb_simple::Command::kLatchCounters: {
      const std::array<int32_t, kMaxStrings> counts = motors_.counts();
      usb_simple::Reading reading;
      for (size_t i = 0; i < usb_simple::kChannels; ++i) reading.counter[i] = counts[i];
      reading.inputs = static_cast<uint8_t>(motors_.inputs() & 0xFF);
      usb_simple::encode_reading(reading, packet_);
      due_ = true;
      break;
    }
    case usb_simple::Command::kEncoderDirection:
      break;  // the wiring is right already
  }
}

size_t EmulatedSimple::reply(MutableBytes bytes) noexcept {
  return copy_out(packet_, bytes, due_);
}

void EmulatedMouse::receive(ByteView bytes) noexcept {
  mouse::Command command{};
  mouse::Force force;
  if (!mouse::decode_command(bytes, command, force)) return;
  if (command == mouse::Command::kQuery) due_ = true;
  if (command == mouse::Command::kStart) started_ = true;
  if (command == mouse::Command::kStop) started_ = false;
  std::array<int, kMaxStrings> milli_N{};
  if (command == mouse::Command::kForce && started_) {
    milli_N[0] = static_cast<int>(std::lround(1000 * force.x_N));
    milli_N[1] = static_cast<int>(std::lround(1000 * force.y_N));
  }
  if (command == mouse::Command::kForce || command == mouse::Command::kStop)
    motors_.put_out(milli_N);
}

size_t EmulatedMouse::reply(MutableBytes bytes) noexcept {
  mouse::Report report;
  mouse::encode_state(report);
  return copy_out(report, bytes, due_);
}

}  // namespace spidar
