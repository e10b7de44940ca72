// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The two CyVerse boards, SH4 and Simple: eight D/A converters from zero volts, eight counters, a
/// rotary switch.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "spidar/devices/cyverse/packets.h"
#include "spidar/link/board.h"
#include "spidar/link/board_parts.h"
#include "spidar/link/encoder_counts.h"
#include "spidar/transports/transport.h"

namespace spidar::boards {

constexpr Traits kCyverseTraits{sh4::kDacBits, 0, false};

/// The D/A converter, from zero to the profile's largest voltage. Its range is not published
/// (inferred, because all published digits are positive).
inline DacScale cyverse_dac(const Profile& profile) noexcept {
  return {sh4::kMaxDigit / profile.dac_max_V, 0, sh4::kMaxDigit};
}

class Cyverse : public OnTransport<Board> {
 public:
  /// Throws DeviceError when the profile describes another board, see require_fitting().
  Cyverse(std::string name, const Profile& profile, std::unique_ptr<Transport> transport,
          int counter_bits);

  void open() final;
  LinkFault cycle(const MotorVolts& volts, DeviceReading& reading,
                  int64_t deadline_ns) noexcept final;
  /// Zeroes the counts on the host; the board's own counters are not changed.
  void zero_counts() noexcept final { counts_.zero(); }
  bool counts_restarted() const noexcept final { return counts_.restarted(); }
  std::vector<LastWill> last_wills() const final;
  int rotary() const noexcept final { return rotary_; }

 protected:
  /// Called before the first exchange after opening.
  virtual LinkFault reset(int64_t deadline_ns) noexcept = 0;
  virtual LinkFault exchange(const CyverseDigits& digits, CyverseReading& reading,
                             int64_t deadline_ns) noexcept = 0;
  /// The packet that sets all motors to zero.
  virtual std::vector<uint8_t> zero_packet() const = 0;

 private:
  const DacScale dac_;
  EncoderCounts counts_;
  int rotary_ = -1;
};

class Sh4 final : public Cyverse {
 public:
  /// Throws DeviceError when the profile describes another board, see require_fitting().
  Sh4(std::string name, const Profile& profile, std::unique_ptr<Transport> transport);

  std::string description() const override;

 private:
  /// The echo may belong to an earlier packet; how far back is not published.
  static constexpr size_t kEchoes = 4;

  LinkFault reset(int64_t deadline_ns) noexcept override;
  LinkFault exchange(const CyverseDigits& digits, CyverseReading& reading,
                     int64_t deadline_ns) noexcept override;
  std::vector<uint8_t> zero_packet() const override;

  sh4::Packet out_{};
  sh4::Packet in_{};
  std::array<CyverseDigits, kEchoes> sent_{};
  size_t sent_at_ = 0;
};

class Simple final : public Cyverse {
 public:
  /// Throws DeviceError when the profile describes another board, see require_fitting().
  Simple(std::string name, const Profile& profile, std::unique_ptr<Transport> transport);

  std::string description() const override;

 private:
  LinkFault reset(int64_t deadline_ns) noexcept override;
  LinkFault exchange(const CyverseDigits& digits, CyverseReading& reading,
                     int64_t deadline_ns) noexcept override;
  std::vector<uint8_t> zero_packet() const override;

  usb_simple::Packet set_dac_{};
  usb_simple::Packet latch_{};
  usb_simple::Packet in_{};
};

}  // namespace spidar::boards
