#include "spidar/boards/simple_board.h"

#include <utility>

#include "spidar/boards/opening.h"

namespace spidar {
namespace {

constexpr uint8_t kAllChannels = 0xFF;

std::array<uint32_t, kMaxStrings> raw_counts(const usb_simple::Reading& reading) noexcept {
  std::array<uint32_t, kMaxStrings> raw{};
  for (size_t i = 0; i < usb_simple::kChannels; ++i)
    raw[i] = static_cast<uint32_t>(reading.counter[i]);
  return raw;
}

}  // namespace

SimpleBoard::SimpleBoard(std::string name, const Profile& profile,
                         std::unique_ptr<Transport> transport)
    : name_(std::move(name)), dac_(unipolar_dac(profile)), transport_(std::move(transport)) {
  require_positive_motors(name_, profile);
  usb_simple::encode_latch(latch_);
}

void SimpleBoard::open() {
  transport_->open();
  transport_->recover();
  usb_simple::Packet direction;
  usb_simple::encode_encoder_direction(kAllChannels, direction);
  usb_simple::Reading reading;
  const LinkFault fault = open_exchange(
      [&](int64_t deadline_ns) {
        const Transfer reset = transport_->exchange({direction}, {}, deadline_ns);
        return reset.fault != LinkFault::kNone ? reset.fault : exchange({}, reading, deadline_ns);
      },
      *transport_);
  if (fault != LinkFault::kNone) {
    transport_->close();
    throw DeviceError(no_answer(name_, fault));
  }
  if (counted_) {
    counts_.resume(raw_counts(reading), usb_simple::kChannels);
  } else {
    counts_.begin(raw_counts(reading), usb_simple::kChannels);
  }
  counted_ = true;
  rotary_ = reading.rotary();
}

LinkFault SimpleBoard::exchange(const usb_simple::DacDigits& digits, usb_simple::Reading& reading,
                                int64_t deadline_ns) noexcept {
  usb_simple::encode_set_dac(digits, set_dac_);
  const Transfer transfer = transport_->exchange({set_dac_, latch_}, in_, deadline_ns);
  if (transfer.fault != LinkFault::kNone) return transfer.fault;
  const bool whole = usb_simple::decode_reading({in_.data(), transfer.received}, reading);
  return whole ? LinkFault::kNone : LinkFault::kShort;
}

LinkFault SimpleBoard::cycle(const MotorVolts& volts, DeviceReading& reading,
                             int64_t deadline_ns) noexcept {
  usb_simple::DacDigits digits{};
  for (size_t i = 0; i < digits.size(); ++i)
    digits[i] = static_cast<uint16_t>(dac_.digit(volts.volt[i]));
  usb_simple::Reading said;
  const LinkFault fault = exchange(digits, said, deadline_ns);
  if (fault != LinkFault::kNone) return fault;
  if (!counts_.follow(raw_counts(said), usb_simple::kChannels)) return LinkFault::kCounterJump;
  reading.count = counts_.counts();
  reading.inputs = said.inputs;
  return LinkFault::kNone;
}

std::vector<LastWill> SimpleBoard::last_wills() const {
  usb_simple::Packet zero;
  usb_simple::encode_set_dac({}, zero);
  return wills(*transport_, {zero});
}

}  // namespace spidar
