// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/simple_board.h"

#include <utility>

namespace spidar {
namespace {

constexpr uint8_t kAllChannels = 0xFF;

}  // namespace

SimpleBoard::SimpleBoard(std::string name, const Profile& profile,
                         std::unique_ptr<Transport> transport)
    : CyverseBoard(std::move(name), profile, std::move(transport), 24) {
  usb_simple::encode_latch(latch_);
}

LinkFault SimpleBoard::reset(int64_t deadline_ns) noexcept {
  usb_simple::Packet direction;
  usb_simple::encode_encoder_direction(kAllChannels, direction);
  return transport().exchange({direction}, {}, deadline_ns).fault;
}

LinkFault SimpleBoard::exchange(const DacDigits& digits, Readout& readout,
                                int64_t deadline_ns) noexcept {
  usb_simple::encode_set_dac(digits, set_dac_);
  const Transfer transfer = transport().exchange({set_dac_, latch_}, in_, deadline_ns);
  if (transfer.fault != LinkFault::kNone) return transfer.fault;
  usb_simple::Reading reading;
  if (!usb_simple::decode_reading({in_.data(), transfer.received}, reading))
    return LinkFault::kShort;
  for (size_t i = 0; i < usb_simple::kChannels; ++i)
    readout.counter[i] = static_cast<uint32_t>(reading.counter[i]);
  readout.inputs = reading.inputs;
  readout.rotary = reading.rotary();
  return LinkFault::kNone;
}

std::string SimpleBoard::description() const {
  return "CyVerse USB 2.0 Simple, rotary switch " + std::to_string(rotary());
}

std::vector<uint8_t> SimpleBoard::zero_packet() const {
  usb_simple::Packet zero;
  usb_simple::encode_set_dac({}, zero);
  return {zero.begin(), zero.end()};
}

}  // namespace spidar
