// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Devices that take a force, driven without a loop.
#pragma once

#include <memory>
#include <utility>

#include "spidar/boards/board.h"
#include "spidar/boards/link_thread.h"
#include "spidar/grip/grip.h"

namespace spidar::test {

/// Forces are switched on; to the right and up.
inline GripCommand told(double right_N, double up_N = 0) {
  GripCommand command;
  command.wrench.force_N = {right_N, up_N, 0};
  command.power = 1;
  return command;
}

/// The same below the grip.
inline ForceOutput pushing(double right_N, double up_N = 0) {
  return {{right_N, up_N, 0}, true};
}

/// A board with its link, as a grip has it.
class LinkedForce {
 public:
  LinkedForce(std::unique_ptr<ForceBoard> board, const BoardSettings& settings)
      : board_(std::move(board)), link_(*board_, settings) {}

  void open() { link_.open(); }
  void close() { link_.close(); }
  ExchangeStatus exchange(const ForceOutput& output, ForceReading& reading) {
    return link_.exchange(output, reading);
  }
  LinkHealth health() const { return link_.health(); }

 private:
  const std::unique_ptr<ForceBoard> board_;
  LinkThread<ForceOutput, ForceReading> link_;
};

}  // namespace spidar::test
