// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "spidar/devices/uart/packets.h"
#include "spidar/link/board.h"
#include "spidar/link/board_parts.h"
#include "spidar/transports/transport.h"

namespace spidar::boards {

/// UART motor boards on one or several lines that form one SPIDAR. Strings are numbered by line,
/// then by board number, then by motor.
class Uart final : public Board {
 public:
  static constexpr Traits kTraits{.dac_bits = uart_motor::kDacBits,
                                  .max_V = uart_motor::kDac_V,
                                  .digits_per_V = uart_motor::kDigitsPerVolt,
                                  .negative = true};

  /// Throws DeviceError when the profile describes another board, see require_fitting().
  Uart(std::string name, const Profile& profile, std::vector<std::unique_ptr<Transport>> lines);

  void open() override;
  LinkFault cycle(const MotorVolts& volts, DeviceReading& reading,
                  int64_t deadline_ns) noexcept override;
  void recover() noexcept override;
  void close() noexcept override;
  std::vector<LastWill> last_wills() const override;
  std::string description() const override;

 private:
  struct Station {
    Transport* line = nullptr;
    int id = 0;
    uart_motor::BoardInfo info;
    size_t first = 0;  ///< the string of the first motor
  };

  void find_stations(Transport& line, int64_t patience_ns);
  void find_all(int64_t patience_ns);
  void require_same_stations();
  LinkFault exchange(const Station& station, const MotorVolts& volts, uart_motor::Reading& reading,
                     int64_t deadline_ns) noexcept;
  LinkFault exchange_all(const MotorVolts& volts, std::array<uint32_t, kMaxStrings>& raw,
                         int64_t deadline_ns) noexcept;

  const size_t strings_;
  const DacScale dac_;
  const std::vector<std::unique_ptr<Transport>> lines_;
  std::vector<Station> stations_;
  size_t motors_ = 0;
  std::string first_description_;  ///< from the first opening
  std::array<uint8_t, uart_motor::kMaxCycleLength> out_{};
  std::array<uint8_t, uart_motor::kMaxReplyLength> in_{};
};

}  // namespace spidar::boards
