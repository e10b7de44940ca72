// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/cyverse/board.h"

#include <algorithm>
#include <utility>

#include "spidar/link/board_parts.h"

namespace spidar::boards {

Cyverse::Cyverse(std::string name, const Profile& profile, std::unique_ptr<Transport> transport,
                 int counter_bits)
    : OnTransport(std::move(name), std::move(transport)),
      dac_(cyverse_dac(profile)),
      counts_(counter_bits) {
  require_fitting(name_, profile, kCyverseTraits);
}

void Cyverse::open() {
  transport_->open();
  transport_->recover();
  CyverseReading now;
  const LinkFault fault = open_exchange(
      [&](int64_t deadline_ns) {
        const LinkFault not_reset = reset(deadline_ns);
        return not_reset != LinkFault::kNone ? not_reset : exchange({}, now, deadline_ns);
      },
      *transport_);
  if (fault != LinkFault::kNone) throw no_answer(name_, fault);
  counts_.open(now.counter, kMaxStrings);
  rotary_ = now.rotary();
}

LinkFault Cyverse::cycle(const MotorVolts& volts, DeviceReading& reading,
                         int64_t deadline_ns) noexcept {
  CyverseDigits digits{};
  for (size_t i = 0; i < digits.size(); ++i) {
    digits[i] = static_cast<uint16_t>(dac_.digit(volts.volt[i]));
  }
  CyverseReading now;
  const LinkFault fault = exchange(digits, now, deadline_ns);
  if (fault != LinkFault::kNone) return fault;
  if (!counts_.update(now.counter, monotonic_now_ns())) return LinkFault::kCounterJump;
  reading.count = counts_.counts();
  reading.inputs = now.inputs;
  return LinkFault::kNone;
}

std::vector<LastWill> Cyverse::last_wills() const {
  const std::vector<uint8_t> zero = zero_packet();
  return wills(*transport_, {{zero.data(), zero.size()}});
}

Sh4::Sh4(std::string name, const Profile& profile, std::unique_ptr<Transport> transport)
    : Cyverse(std::move(name), profile, std::move(transport), 16) {}

/// The published host only resets the pipe, which the transport has done already.
LinkFault Sh4::reset(int64_t) noexcept {
  sent_ = {};
  return LinkFault::kNone;
}

LinkFault Sh4::exchange(const CyverseDigits& digits, CyverseReading& reading,
                        int64_t deadline_ns) noexcept {
  sent_[sent_at_] = digits;
  sent_at_ = (sent_at_ + 1) % kEchoes;
  sh4::encode_update(digits, out_);
  const Transfer transfer = transport_->exchange({out_}, in_, deadline_ns);
  if (transfer.fault != LinkFault::kNone) return transfer.fault;
  sh4::Reading whole;
  if (!sh4::decode_reading({in_.data(), transfer.received}, whole)) return LinkFault::kShort;
  if (std::find(sent_.begin(), sent_.end(), whole.dac_echo) == sent_.end()) {
    return LinkFault::kWrongEcho;
  }
  // Negated, because this board counts in the opposite direction to the Simple board (published).
  for (uint32_t& counter : whole.counter) counter = 0u - counter;
  reading = whole;
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

namespace {

constexpr uint8_t kAllChannels = 0xFF;

}  // namespace

Simple::Simple(std::string name, const Profile& profile, std::unique_ptr<Transport> transport)
    : Cyverse(std::move(name), profile, std::move(transport), 24) {
  usb_simple::encode_latch(latch_);
}

LinkFault Simple::reset(int64_t deadline_ns) noexcept {
  usb_simple::Packet direction;
  usb_simple::encode_encoder_direction(kAllChannels, direction);
  return transport_->exchange({direction}, {}, deadline_ns).fault;
}

LinkFault Simple::exchange(const CyverseDigits& digits, CyverseReading& reading,
                           int64_t deadline_ns) noexcept {
  usb_simple::encode_set_dac(digits, set_dac_);
  const Transfer transfer = transport_->exchange({set_dac_, latch_}, in_, deadline_ns);
  if (transfer.fault != LinkFault::kNone) return transfer.fault;
  const bool is_whole = usb_simple::decode_reading({in_.data(), transfer.received}, reading);
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
