// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Devices that take a force, on an emulated wire.
#pragma once

#include <memory>
#include <string>

#include "spidar/devices/falcon/emulated.h"
#include "spidar/devices/force_feedback/board.h"
#include "spidar/devices/force_feedback/emulated.h"
#include "spidar/link/emulated_transport.h"
#include "spidar/link/force_grip.h"
#include "tests/spidar/kinds.h"
#include "tests/support/pushed_grip.h"
#include "tests/support/recorded_motors.h"

namespace spidar::test {

/// The digits of the motors are the force: right, up.
struct ForceBench {
  /// "mouse"
  explicit ForceBench(const std::string& board)
      : kind(kind_of(board)), is_falcon(board == "falcon") {
    if (is_falcon) motors.inputs = emulated::Falcon::kHomed;
  }

  std::unique_ptr<boards::ForceBoard> board() {
    return std::get<std::unique_ptr<boards::ForceBoard>>(
        kind.attach(kind.board, profile, wire_to(kind.emulate(recorded), wire)));
  }
  static boards::Settings settings(bool threaded) {
    boards::Settings settings;
    settings.threaded = threaded;
    return settings;
  }
  std::unique_ptr<boards::ForceLink> linked(bool threaded = false) {
    return std::make_unique<boards::ForceLink>(board(), settings(threaded));
  }
  std::unique_ptr<boards::ForceGrip> grip() {
    return std::make_unique<boards::ForceGrip>(linked());
  }

  /// Number of exchanges in which it communicates with the device once.
  int cycles() {
    // A card takes every level, and plays the newest one.
    return kind.board == std::string("sound") ? 1 : 1000 / board()->abilities().rate_Hz;
  }
  /// Largest error of a digit of the recorded motors, in a middle position: half a digit of each of
  /// the Falcon's motors, 0.05 mN m, at some 44 mm/rad; others round once.
  int rounding() const { return is_falcon ? 3 : 1; }

  const DeviceKind& kind;
  const bool is_falcon;
  const Profile profile = load_profile("spidar-g6x3-v2-r");
  MotorBench motors;
  std::shared_ptr<RecordedMotors> recorded = std::make_shared<RecordedMotors>(motors);
  std::shared_ptr<std::atomic<LinkFault>> wire =
      std::make_shared<std::atomic<LinkFault>>(LinkFault::kNone);
};

}  // namespace spidar::test
