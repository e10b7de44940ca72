// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The two CyVerse boards, SH4 and Simple: eight unipolar D/A converters, eight counters, a switch.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "spidar/devices/cyverse/packets.h"
#include "spidar/link/board_parts.h"

namespace spidar::boards {

class Sh4 final : public StringBoard {
 public:
  /// The range of the D/A converters is inferred from the published digits, which are all positive.
  static constexpr Traits kTraits{.dac_bits = sh4::kDacBits, .counter_bits = 16};

  Sh4(std::string name, const Profile& profile, std::unique_ptr<Transport> transport)
      : StringBoard(std::move(name), profile, std::move(transport), kTraits) {}

  std::string description() const override;

 private:
  /// The echo may belong to an earlier packet; how much earlier is not published.
  static constexpr size_t kEchoes = 4;

  LinkFault reset(int64_t deadline_ns) noexcept override;
  LinkFault exchange(const Digits& digits, Answer& answer, int64_t deadline_ns) noexcept override;
  std::vector<uint8_t> zero_packet() const override;

  sh4::Packet out_{};
  sh4::Packet in_{};
  std::array<Digits, kEchoes> sent_{};
  size_t sent_at_ = 0;
};

class Simple final : public StringBoard {
 public:
  static constexpr Traits kTraits{.dac_bits = usb_simple::kDacBits, .counter_bits = 24};

  Simple(std::string name, const Profile& profile, std::unique_ptr<Transport> transport)
      : StringBoard(std::move(name), profile, std::move(transport), kTraits) {
    usb_simple::encode_latch(latch_);
  }

  std::string description() const override;

 private:
  LinkFault reset(int64_t deadline_ns) noexcept override;
  LinkFault exchange(const Digits& digits, Answer& answer, int64_t deadline_ns) noexcept override;
  std::vector<uint8_t> zero_packet() const override;

  usb_simple::Packet set_dac_{};
  usb_simple::Packet latch_{};
  usb_simple::Packet in_{};
};

}  // namespace spidar::boards
