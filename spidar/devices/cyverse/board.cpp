// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/cyverse/board.h"

#include <algorithm>

#include "spidar/devices/cyverse/emulated.h"
#include "spidar/link/device_kind.h"

namespace spidar::boards {

/// The published host only resets the pipe, which the transport has already done.
LinkFault Sh4::reset(int64_t) noexcept {
  sent_ = {};
  return LinkFault::kNone;
}

LinkFault Sh4::exchange(const Digits& digits, Answer& answer, int64_t deadline_ns) noexcept {
  sent_[sent_at_] = digits;
  sent_at_ = (sent_at_ + 1) % kEchoes;
  sh4::encode_update(digits, out_);
  const Transfer transfer = transport_->exchange({out_}, in_, deadline_ns);
  if (transfer.fault != LinkFault::kNone) return transfer.fault;
  sh4::Reading reading;
  if (!sh4::decode_reading({in_.data(), transfer.received}, reading)) return LinkFault::kShort;
  if (std::find(sent_.begin(), sent_.end(), reading.dac_echo) == sent_.end()) {
    return LinkFault::kWrongEcho;
  }
  // The published host negates the counters, because this board counts in the opposite direction to
  // the Simple board.
  for (uint32_t& counter : reading.counter) counter = 0u - counter;
  answer = {reading.counter, reading.inputs, reading.rotary()};
  return LinkFault::kNone;
}

std::string Sh4::description() const {
  return transport_->where() + "CyVerse USB 2.0 SH4, rotary switch " + std::to_string(rotary());
}

std::vector<uint8_t> Sh4::zero_packet() const {
  sh4::Packet zero;
  sh4::encode_update({}, zero);
  return {zero.begin(), zero.end()};
}

LinkFault Simple::reset(int64_t deadline_ns) noexcept {
  constexpr uint8_t kAllChannels = 0xFF;
  usb_simple::Packet direction;
  usb_simple::encode_encoder_direction(kAllChannels, direction);
  return transport_->exchange({direction}, {}, deadline_ns).fault;
}

LinkFault Simple::exchange(const Digits& digits, Answer& answer, int64_t deadline_ns) noexcept {
  usb_simple::encode_set_dac(digits, set_dac_);
  const Transfer transfer = transport_->exchange({set_dac_, latch_}, in_, deadline_ns);
  if (transfer.fault != LinkFault::kNone) return transfer.fault;
  CyverseReading reading;
  const bool is_whole = usb_simple::decode_reading({in_.data(), transfer.received}, reading);
  answer = {reading.counter, reading.inputs, reading.rotary()};
  return is_whole ? LinkFault::kNone : LinkFault::kShort;
}

std::string Simple::description() const {
  return transport_->where() + "CyVerse USB 2.0 Simple, rotary switch " + std::to_string(rotary());
}

std::vector<uint8_t> Simple::zero_packet() const {
  usb_simple::Packet zero;
  usb_simple::encode_set_dac({}, zero);
  return {zero.begin(), zero.end()};
}

}  // namespace spidar::boards

namespace spidar {
namespace {

/// The profile of a simulation of these boards, which output positive voltages only: the usual
/// profile needs both signs. Real boards have no default (see profile_choice.h).
constexpr const char* kUnipolarProfile = "spidar-g6x3-v2-r";

constexpr const char* kInferred = "endpoints and D/A range are inferred";

}  // namespace

std::vector<DeviceKind> cyverse_kinds() {
  return {{.device = "usb",
           .board = "sh4",
           .title = "CyVerse USB 2.0 SH4",
           .names = "usb, usb:ID",
           .usb = {sh4::kVendor, sh4::kProduct, sh4::kEndpointOut, sh4::kEndpointIn},
           .profile_board = "usb-sh4",
           .profile = kUnipolarProfile,
           .traits = boards::Sh4::kTraits,
           .note = kInferred,
           .attach = attach<boards::Sh4>,
           .emulate = emulate<emulated::Sh4>},
          {.device = "usb",
           .board = "simple",
           .title = "CyVerse USB 2.0 Simple",
           .names = "usb, usb:ID",
           .usb = {usb_simple::kVendor, usb_simple::kProduct, usb_simple::kEndpointOut,
                   usb_simple::kEndpointIn},
           .profile_board = "usb-simple",
           .profile = kUnipolarProfile,
           .traits = boards::Simple::kTraits,
           .note = kInferred,
           .attach = attach<boards::Simple>,
           .emulate = emulate<emulated::Simple>}};
}

}  // namespace spidar
