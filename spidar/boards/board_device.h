// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Adapter from a board to the device interface of the haptic loop.
#pragma once

#include <memory>
#include <string>

#include "spidar/boards/board.h"
#include "spidar/boards/board_link.h"
#include "spidar/boards/board_settings.h"
#include "spidar/device.h"

namespace spidar {

/// Decides when the counts are set to zero, and leaves all else to the link.
class BoardDevice final : public Device {
 public:
  using Link = BoardLink<MotorVolts, DeviceReading>;
  static constexpr int64_t kReplyWait_ns = Link::kReplyWait_ns;
  static constexpr int64_t kTransfer_ns = Link::kTransfer_ns;
  static constexpr int kRamp_ms = Link::kRamp_ms;

  /// CountZero::kByProfile is for make_device(); here it means kFirstOpen.
  BoardDevice(std::unique_ptr<Board> board, const BoardSettings& settings);

  void open() override;
  ExchangeStatus exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    return link_.exchange(volts, reading);
  }
  void close() noexcept override { link_.close(); }
  std::string description() const override { return link_.description(); }
  const std::string& name() const noexcept override { return board_->name(); }
  LinkHealth health() const noexcept override { return link_.health(); }

 private:
  const std::unique_ptr<Board> board_;
  const CountZero count_zero_;
  bool zeroed_ = false;  // the counts have been zeroed once
  Link link_;
};

}  // namespace spidar
