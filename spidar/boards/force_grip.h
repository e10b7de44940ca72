// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A grip that takes its force as it is.
#pragma once

#include <memory>
#include <string>

#include "spidar/boards/board.h"
#include "spidar/boards/link_thread.h"
#include "spidar/grip/grip.h"
#include "spidar/grip/pose_trust.h"

namespace spidar {

/// Hands the force to its board in the axes in which that is felt, up to what that can give, and
/// takes the position from it. There is no torque, and no rotation.
class ForceGrip final : public Grip {
 public:
  /// Only the settings of the guardian and of the thread are used.
  ForceGrip(std::unique_ptr<ForceBoard> board, const BoardSettings& settings);

  void open() override;
  void check_age(int64_t now_ns) noexcept override;
  ExchangeStatus exchange(const GripCommand& command) noexcept override;
  const GripReading& reading() const noexcept override { return reading_; }
  void close() noexcept override { link_.close(); }
  const GripTraits& traits() const noexcept override { return traits_; }
  std::string description() const override { return link_.description(); }
  GripAbilities abilities() const noexcept override { return board_->abilities(); }
  LinkHealth health() const noexcept override { return link_.health(); }
  const std::string& name() const noexcept override { return board_->name(); }

 private:
  ForceOutput output_for(const GripCommand& command) const noexcept;
  void see(const ForceReading& answer, const GripCommand& command) noexcept;
  PoseTrouble judge(const ForceReading& answer, int64_t now_ns) const noexcept;

  const std::unique_ptr<ForceBoard> board_;
  const GripTraits traits_;
  GripReading reading_;
  PoseTrust trust_;
  LinkThread<ForceOutput, ForceReading> link_;
};

}  // namespace spidar
