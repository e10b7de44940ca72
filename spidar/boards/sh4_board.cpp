#include "spidar/boards/sh4_board.h"

#include <algorithm>
#include <utility>

#include "spidar/boards/opening.h"
#include "spidar/monotonic.h"

namespace spidar {
namespace {

/// The host negates: this board counts the other way round than the Simple one (published).
std::array<uint32_t, kMaxStrings> raw_counts(const sh4::Reading& reading) noexcept {
  std::array<uint32_t, kMaxStrings> raw{};
  for (size_t i = 0; i < sh4::kChannels; ++i) raw[i] = 0u - reading.counter[i];
  return raw;
}

}  // namespace

Sh4Board::Sh4Board(std::string name, const Profile& profile, std::unique_ptr<Transport> transport)
    : name_(std::move(name)), dac_(unipolar_dac(profile)), transport_(std::move(transport)) {
  require_positive_motors(name_, profile);
}

void Sh4Board::open() {
  transport_->open();
  transport_->recover();
  sent_ = {};
  sh4::Reading reading;
  const LinkFault fault = open_exchange(
      [&](int64_t deadline_ns) { return exchange({}, reading, deadline_ns); }, *transport_);
  if (fault != LinkFault::kNone) {
    transport_->close();
    throw DeviceError(no_answer(name_, fault));
  }
  if (counted_) {
    counts_.resume(raw_counts(reading), sh4::kChannels);
  } else {
    counts_.begin(raw_counts(reading), sh4::kChannels);
  }
  counted_ = true;
  rotary_ = reading.rotary();
}

LinkFault Sh4Board::exchange(const sh4::DacDigits& digits, sh4::Reading& reading,
                             int64_t deadline_ns) noexcept {
  sent_[sent_at_] = digits;
  sent_at_ = (sent_at_ + 1) % kEchoes;
  sh4::encode_update(digits, out_);
  const Transfer transfer = transport_->exchange({out_}, in_, deadline_ns);
  if (transfer.fault != LinkFault::kNone) return transfer.fault;
  if (!sh4::decode_reading({in_.data(), transfer.received}, reading)) return LinkFault::kShort;
  const bool sent = std::find(sent_.begin(), sent_.end(), reading.dac_echo) != sent_.end();
  return sent ? LinkFault::kNone : LinkFault::kWrongEcho;
}

LinkFault Sh4Board::cycle(const MotorVolts& volts, DeviceReading& reading,
                          int64_t deadline_ns) noexcept {
  sh4::DacDigits digits{};
  for (size_t i = 0; i < digits.size(); ++i)
    digits[i] = static_cast<uint16_t>(dac_.digit(volts.volt[i]));
  sh4::Reading said;
  const LinkFault fault = exchange(digits, said, deadline_ns);
  if (fault != LinkFault::kNone) return fault;
  if (!counts_.follow(raw_counts(said), sh4::kChannels)) return LinkFault::kCounterJump;
  reading.count = counts_.counts();
  reading.inputs = said.inputs;
  return LinkFault::kNone;
}

std::vector<LastWill> Sh4Board::last_wills() const {
  sh4::Packet zero;
  sh4::encode_update({}, zero);
  return wills(*transport_, {zero});
}

}  // namespace spidar
