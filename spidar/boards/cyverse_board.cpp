// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/cyverse_board.h"

#include <utility>

#include "spidar/boards/opening.h"

namespace spidar {

CyverseBoard::CyverseBoard(std::string name, const Profile& profile,
                           std::unique_ptr<Transport> transport, int counter_bits)
    : name_(std::move(name)),
      dac_(unipolar_dac(profile)),
      transport_(std::move(transport)),
      counts_(counter_bits) {
  require_positive_motors(name_, profile);
}

void CyverseBoard::open() {
  transport_->open();
  transport_->recover();
  Readout readout;
  const LinkFault fault = open_exchange(
      [&](int64_t deadline_ns) {
        const LinkFault not_reset = reset(deadline_ns);
        return not_reset != LinkFault::kNone ? not_reset : exchange({}, readout, deadline_ns);
      },
      *transport_);
  if (fault != LinkFault::kNone) {
    transport_->close();
    throw DeviceError(no_answer(name_, fault));
  }
  counts_.open(readout.counter, kMaxStrings);
  rotary_ = readout.rotary;
}

LinkFault CyverseBoard::cycle(const MotorVolts& volts, DeviceReading& reading,
                              int64_t deadline_ns) noexcept {
  DacDigits digits{};
  for (size_t i = 0; i < digits.size(); ++i)
    digits[i] = static_cast<uint16_t>(dac_.digit(volts.volt[i]));
  Readout readout;
  const LinkFault fault = exchange(digits, readout, deadline_ns);
  if (fault != LinkFault::kNone) return fault;
  if (!counts_.follow(readout.counter, monotonic_now_ns())) return LinkFault::kCounterJump;
  reading.count = counts_.counts();
  reading.inputs = readout.inputs;
  return LinkFault::kNone;
}

std::vector<LastWill> CyverseBoard::last_wills() const {
  const std::vector<uint8_t> zero = zero_packet();
  return wills(*transport_, {{zero.data(), zero.size()}});
}

}  // namespace spidar
