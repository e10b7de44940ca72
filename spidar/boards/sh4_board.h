// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The CyVerse USB 2.0 SH4 board: one packet out, one in.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/cyverse_board.h"
#include "spidar/protocols/sh4.h"

namespace spidar {

class Sh4Board final : public CyverseBoard {
 public:
  /// Throws DeviceError when the profile wants negative volts.
  Sh4Board(std::string name, const Profile& profile, std::unique_ptr<Transport> transport);

  std::string description() const override;

 private:
  /// The echo may belong to an earlier packet; how far back is not published.
  static constexpr size_t kEchoes = 4;

  LinkFault reset(int64_t deadline_ns) noexcept override;
  LinkFault exchange(const DacDigits& digits, Readout& readout,
                     int64_t deadline_ns) noexcept override;
  std::vector<uint8_t> zero_packet() const override;

  sh4::Packet out_{};
  sh4::Packet in_{};
  std::array<DacDigits, kEchoes> sent_{};
  size_t sent_at_ = 0;
};

}  // namespace spidar
