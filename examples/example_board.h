// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A whole device with strings, the example of docs/extend.md: its board, its emulation, and its
/// kind. The device does not exist: it takes a packet of eight 16-bit digits and answers with eight
/// 16-bit counters.
#pragma once

#include "spidar/link/board_parts.h"
#include "spidar/link/device_kind.h"

namespace spidar {

using ExamplePacket = std::array<uint8_t, 2 * kMaxStrings>;

class ExampleBoard final : public boards::StringBoard {
 public:
  static constexpr boards::Traits kTraits{.dac_bits = 12, .counter_bits = 16};

  ExampleBoard(std::string name, const Profile& profile, std::unique_ptr<Transport> transport)
      : StringBoard(std::move(name), profile, std::move(transport), kTraits) {}

  std::string description() const override { return transport_->where() + "example"; }

 private:
  LinkFault exchange(const Digits& digits, Answer& answer, int64_t deadline_ns) noexcept override {
    ExamplePacket out{}, in{};
    for (size_t i = 0; i < digits.size(); ++i) {
      MutableBytes(out).put_u16(2 * i, static_cast<uint16_t>(digits[i]));
    }
    const LinkFault fault = transport_->exchange({out}, in, deadline_ns).fault;
    for (size_t i = 0; i < digits.size(); ++i) answer.counter[i] = ByteView(in).u16(2 * i);
    return fault;
  }
  std::vector<uint8_t> zero_packet() const override {
    return std::vector<uint8_t>(sizeof(ExamplePacket));
  }
};

class EmulatedExample final : public emulated::Board {
 public:
  using Board::Board;
  void receive(ByteView bytes) noexcept override {
    std::array<int, kMaxStrings> digits{};
    for (size_t i = 0; i < digits.size(); ++i) digits[i] = bytes.u16(2 * i);
    motors_->set_outputs(digits);
    const std::array<int32_t, kMaxStrings> counts = motors_->counts();
    for (size_t i = 0; i < counts.size(); ++i) {
      MutableBytes(answer_).put_u16(2 * i, static_cast<uint16_t>(counts[i]));
    }
    due_ = true;
  }
  size_t reply(MutableBytes bytes) noexcept override {
    return emulated::copy_out(answer_, bytes, due_);
  }

 private:
  ExamplePacket answer_{};
  bool due_ = false;
};

inline std::vector<DeviceKind> example_kinds() {
  return {{.device = "example",
           .board = "example",
           .title = "example board",
           .names = "example, example:ID",
           .usb = {.vendor = 0x1209, .product = 0x0001, .out = 0x01, .in = 0x81},
           .profile_board = "example",
           .profile = "spidar-g645",
           .traits = ExampleBoard::kTraits,
           .attach = attach<ExampleBoard>,
           .emulate = emulate<EmulatedExample>}};
}

}  // namespace spidar
