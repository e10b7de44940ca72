// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The SPIDAR-mouse: two force axes, no encoders.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/profiles/profile.h"
#include "spidar/protocols/spidar_mouse.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// Replaces the strings of any profile. The force is the pull of the strings on a grip at the
/// centre, the position that this board always reports; only its x and y are felt.
class MouseBoard final : public Board {
 public:
  static constexpr FeltParts kFelt{true, true, false, false, true};

  MouseBoard(std::string name, const Profile& profile, std::unique_ptr<Transport> transport);

  void open() override;
  LinkFault cycle(const MotorVolts& volts, DeviceReading& reading,
                  int64_t deadline_ns) noexcept override;
  void recover() noexcept override { transport_->recover(); }
  /// Does nothing: the board has no counters.
  void zero_counts() noexcept override {}
  void close() noexcept override;
  std::vector<LastWill> last_wills() const override;
  std::string description() const override { return "SPIDAR-mouse"; }
  FeltParts felt_parts() const noexcept override { return kFelt; }
  const std::string& name() const noexcept override { return name_; }

 private:
  /// Period at which the published program sends a force, 4 ms.
  static constexpr int kCyclesPerReport = 4;

  const std::string name_;
  const std::unique_ptr<Transport> transport_;
  Eigen::Matrix<double, 2, kMaxStrings> force_per_volt_;  ///< N/V, at the centre
  std::array<int32_t, kMaxStrings> home_count_{};
  bool started_ = false;
  int cycle_ = 0;
  mouse::Report out_{};
  mouse::Report in_{};
};

}  // namespace spidar
