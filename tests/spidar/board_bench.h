// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Boards on an emulated wire.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "spidar/devices/cyverse/board.h"
#include "spidar/devices/cyverse/emulated.h"
#include "spidar/devices/uart/board.h"
#include "spidar/devices/uart/emulated.h"
#include "spidar/link/emulated_transport.h"
#include "spidar/link/link_thread.h"
#include "spidar/session/haptic_session.h"
#include "tests/spidar/kinds.h"
#include "tests/support/recorded_motors.h"

namespace spidar::test {

struct BoardBench {
  /// "sh4"
  explicit BoardBench(const std::string& board) : kind(kind_of(board)), is_uart(board == "uart") {}

  std::unique_ptr<Transport> transport_to(std::unique_ptr<emulated::Board> emulated) {
    return wire_to(std::move(emulated), wire);
  }

  std::unique_ptr<boards::Board> board() {
    return std::get<std::unique_ptr<boards::Board>>(
        kind.attach(kind.board, profile, transport_to(kind.emulate(recorded))));
  }

  std::unique_ptr<boards::StringLink> device(
      bool threaded = false, boards::CountZero count_zero = boards::CountZero::kFirstOpen) {
    boards::Settings settings;
    settings.threaded = threaded;
    settings.count_zero = count_zero;
    return std::make_unique<boards::StringLink>(board(), settings);
  }

  const DeviceKind& kind;
  const bool is_uart;
  /// For the D/A of the boards: up to 9.867 V, or 3.3 V.
  const Profile profile = load_profile(is_uart ? "spidar-g6x" : kind.profile);
  MotorBench motors;
  std::shared_ptr<RecordedMotors> recorded = std::make_shared<RecordedMotors>(motors);
  std::shared_ptr<std::atomic<LinkFault>> wire =
      std::make_shared<std::atomic<LinkFault>>(LinkFault::kNone);
};

inline MotorVolts all_volts(double volt) {
  MotorVolts volts;
  volts.volt.fill(volt);
  return volts;
}

}  // namespace spidar::test
