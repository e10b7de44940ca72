// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The SPIDAR-mouse: two force axes, no position.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "spidar/boards/board.h"
#include "spidar/protocols/spidar_mouse.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// Its grip is always at the centre.
class MouseBoard final : public ForceBoard {
 public:
  MouseBoard(std::string name, std::unique_ptr<Transport> transport);

  void open() override;
  LinkFault cycle(const ForceOutput& output, ForceReading& reading,
                  int64_t deadline_ns) noexcept override;
  void recover() noexcept override { transport_->recover(); }
  void close() noexcept override;
  std::vector<LastWill> last_wills() const override;
  std::string description() const override { return "SPIDAR-mouse"; }
  GripAbilities abilities() const noexcept override { return kAbilities; }
  const std::string& name() const noexcept override { return name_; }

 private:
  /// Period at which the published program sends a force, 4 ms.
  static constexpr int kCyclesPerReport = 4;
  static constexpr GripAbilities kAbilities{
      {true, true, false}, false, true, {}, mouse::kMaxForce_N, 1000 / kCyclesPerReport};

  const std::string name_;
  const std::unique_ptr<Transport> transport_;
  bool started_ = false;
  int cycle_ = 0;
  mouse::Report out_{};
  mouse::Report in_{};
};

}  // namespace spidar
