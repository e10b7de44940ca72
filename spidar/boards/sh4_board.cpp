// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/sh4_board.h"

#include <algorithm>
#include <utility>

namespace spidar {

Sh4Board::Sh4Board(std::string name, const Profile& profile, std::unique_ptr<Transport> transport)
    : CyverseBoard(std::move(name), profile, std::move(transport), 16) {}

/// The published host only resets the pipe, which the transport has done already.
LinkFault Sh4Board::reset(int64_t) noexcept {
  sent_ = {};
  return LinkFault::kNone;
}

LinkFault Sh4Board::exchange(const DacDigits& digits, Readout& readout,
                             int64_t deadline_ns) noexcept {
  sent_[sent_at_] = digits;
  sent_at_ = (sent_at_ + 1) % kEchoes;
  sh4::encode_update(digits, out_);
  const Transfer transfer = transport().exchange({out_}, in_, deadline_ns);
  if (transfer.fault != LinkFault::kNone) return transfer.fault;
  sh4::Reading reading;
  if (!sh4::decode_reading({in_.data(), transfer.received}, reading)) return LinkFault::kShort;
  if (std::find(sent_.begin(), sent_.end(), reading.dac_echo) == sent_.end())
    return LinkFault::kWrongEcho;
  // Negated, because this board counts in the opposite direction to the Simple board (published).
  for (size_t i = 0; i < sh4::kChannels; ++i) readout.counter[i] = 0u - reading.counter[i];
  readout.inputs = reading.inputs;
  readout.rotary = reading.rotary();
  return LinkFault::kNone;
}

std::string Sh4Board::description() const {
  return "CyVerse USB 2.0 SH4, rotary switch " + std::to_string(rotary());
}

std::vector<uint8_t> Sh4Board::zero_packet() const {
  sh4::Packet zero;
  sh4::encode_update({}, zero);
  return {zero.begin(), zero.end()};
}

}  // namespace spidar
