// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/link/board_parts.h"

#include "spidar/link/encoder_counts.h"
#include "spidar/text.h"

namespace spidar::boards {
namespace {

/// The largest speed of a hand with a grip (EncoderCounts). A faster counter counts as broken.
constexpr double kFastestHand_m_s = 10;
constexpr double kLeast_m_per_count =
    kFastestHand_m_s * 1e-3 / static_cast<double>(EncoderCounts::kMaxStepPer_ms);

}  // namespace

std::string misfit(const Profile& profile, const Traits& board) {
  if (profile.dac_bits != board.dac_bits) {
    return "has dac_bits = " + as_text(profile.dac_bits) + ", and the D/A of the board has " +
           as_text(board.dac_bits) + " bits: take a profile for this board, or correct dac_bits";
  }
  for (size_t i = 0; i < static_cast<size_t>(profile.geometry.count); ++i) {
    const StringDrive& drive = profile.drives[i];
    const std::string string = " for string " + as_text(i);
    if (drive.motor_sign < 0 && !board.negative) {
      return "wants negative volts" + string +
             " (motor_sign), and the board puts out positive ones only: take a profile for this "
             "board, or correct motor_sign";
    }
    const double needed_V = drive.max_tension_N / drive.newtons_per_volt;
    if (board.max_V > 0 && !(needed_V <= board.max_V)) {
      return "wants " + as_text(needed_V) + " V" + string +
             " (max_tension_N), and the board puts out " + as_text(board.max_V) +
             " V at most: lower max_tension_N, or correct newtons_per_volt";
    }
    if (!(drive.metres_per_count >= kLeast_m_per_count)) {
      return "has metres_per_count = " + as_text(drive.metres_per_count) + string +
             ", and the driver follows the board's counters for a hand at " +
             as_text(kFastestHand_m_s) + " m/s from " + as_text(kLeast_m_per_count) +
             " m on: correct metres_per_count";
    }
  }
  return {};
}

void require_fitting(const std::string& device, const Profile& profile, const Traits& board) {
  const std::string why = misfit(profile, board);
  if (!why.empty()) {
    throw DeviceError(device + ": profile \"" + profile.name + "\" " + why,
                      DeviceErrorCode::kSettings);
  }
}

StringBoard::StringBoard(std::string name, const Profile& profile,
                         std::unique_ptr<Transport> transport, const Traits& traits)
    : OnTransport(std::move(name), std::move(transport), traits.counter_bits),
      dac_(traits.dac(profile)) {
  require_fitting(name_, profile, traits);
}

void StringBoard::open() {
  transport_->open();
  transport_->recover();
  Answer now;
  const LinkFault fault = open_exchange(
      [&](int64_t deadline_ns) {
        const LinkFault not_reset = reset(deadline_ns);
        return not_reset != LinkFault::kNone ? not_reset : exchange({}, now, deadline_ns);
      },
      *transport_);
  if (fault != LinkFault::kNone) throw no_answer(name_, fault);
  counts_.open(now.counter, kMaxStrings);
  rotary_ = now.rotary;
}

LinkFault StringBoard::cycle(const MotorVolts& volts, DeviceReading& reading,
                             int64_t deadline_ns) noexcept {
  Digits digits{};
  for (size_t i = 0; i < digits.size(); ++i) digits[i] = dac_.digit(volts.volt[i]);
  Answer now;
  LinkFault fault = exchange(digits, now, deadline_ns);
  if (fault == LinkFault::kNone) fault = update_counts(now.counter, reading);
  if (fault == LinkFault::kNone) reading.inputs = now.inputs;
  return fault;
}

std::vector<LastWill> StringBoard::last_wills() const {
  const std::vector<uint8_t> zero = zero_packet();
  return wills(*transport_, {{zero.data(), zero.size()}});
}

}  // namespace spidar::boards
