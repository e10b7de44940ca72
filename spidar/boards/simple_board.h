// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The CyVerse USB 2.0 Simple board: D/A and latch out, counters in.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/cyverse_board.h"
#include "spidar/protocols/usb_simple.h"

namespace spidar {

class SimpleBoard final : public CyverseBoard {
 public:
  /// Throws DeviceError when the profile wants negative volts.
  SimpleBoard(std::string name, const Profile& profile, std::unique_ptr<Transport> transport);

  std::string description() const override;

 private:
  LinkFault reset(int64_t deadline_ns) noexcept override;
  LinkFault exchange(const DacDigits& digits, Readout& readout,
                     int64_t deadline_ns) noexcept override;
  std::vector<uint8_t> zero_packet() const override;

  usb_simple::Packet set_dac_{};
  usb_simple::Packet latch_{};
  usb_simple::Packet in_{};
};

}  // namespace spidar
