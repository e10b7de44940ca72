// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A board of sixty lines, the example of docs/extend.md. It does not exist: it takes a
/// packet of eight 16-bit digits and answers with eight 16-bit counters.
#pragma once

#include "spidar/link/board.h"
#include "spidar/link/board_parts.h"
#include "spidar/link/encoder_counts.h"

namespace spidar {

class ExampleBoard final : public boards::OnTransport<boards::Board> {
 public:
  ExampleBoard(std::string name, const Profile& profile, std::unique_ptr<Transport> transport)
      : OnTransport(std::move(name), std::move(transport)),
        dac_{4095 / profile.dac_max_V, 0, 4095} {
    boards::require_fitting(name_, profile, {12, 0, false});  // bits, largest volts, negative ones
  }

  void open() override {
    transport_->open();
    Raw raw{};
    const LinkFault fault =
        boards::open_exchange([&](int64_t until) { return exchange({}, raw, until); }, *transport_);
    if (fault != LinkFault::kNone) throw boards::no_answer(name_, fault);
    counts_.open(raw, kMaxStrings);
  }
  LinkFault cycle(const MotorVolts& volts, DeviceReading& reading,
                  int64_t deadline_ns) noexcept override {
    Raw raw{};
    const LinkFault fault = exchange(volts, raw, deadline_ns);
    if (fault != LinkFault::kNone) return fault;
    if (!counts_.update(raw, monotonic_now_ns())) return LinkFault::kCounterJump;
    reading.count = counts_.counts();
    return LinkFault::kNone;
  }
  void zero_counts() noexcept override { counts_.zero(); }
  bool counts_restarted() const noexcept override { return counts_.restarted(); }
  std::vector<LastWill> last_wills() const override {
    return boards::wills(*transport_, {std::array<uint8_t, 16>{}});
  }
  std::string description() const override { return "example"; }

 private:
  using Raw = std::array<uint32_t, kMaxStrings>;

  LinkFault exchange(const MotorVolts& volts, Raw& raw, int64_t deadline_ns) noexcept {
    std::array<uint8_t, 16> out{}, in{};
    for (size_t i = 0; i < raw.size(); ++i)
      MutableBytes(out).put_u16(2 * i, static_cast<uint16_t>(dac_.digit(volts.volt[i])));
    const LinkFault fault = transport_->exchange({out}, in, deadline_ns).fault;
    for (size_t i = 0; i < raw.size(); ++i) raw[i] = ByteView(in).u16(2 * i);
    return fault;
  }

  const boards::DacScale dac_;
  boards::EncoderCounts counts_{16};
};

}  // namespace spidar
