// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Devices that take a force, on an emulated wire.
#pragma once

#include <memory>
#include <string>

#include "spidar/boards/falcon_board.h"
#include "spidar/boards/force_feedback_board.h"
#include "spidar/boards/force_grip.h"
#include "spidar/boards/inverse3_board.h"
#include "spidar/boards/mouse_board.h"
#include "spidar/emulation/emulated_boards.h"
#include "spidar/emulation/emulated_force_devices.h"
#include "spidar/emulation/emulated_transport.h"
#include "tests/support/pushed_grip.h"
#include "tests/support/recorded_motors.h"

namespace spidar::test {

enum class ForceKind { kMouse, kForceFeedback, kInverse3, kFalcon };

inline std::string name_of(ForceKind kind) {
  if (kind == ForceKind::kFalcon) return "falcon";
  return kind == ForceKind::kMouse ? "mouse" : kind == ForceKind::kInverse3 ? "inverse3" : "ff";
}

/// The digits of the motors are the force: right, up.
struct ForceBench {
  explicit ForceBench(ForceKind of) : kind(of) {
    memory.loaded = true;
    if (kind == ForceKind::kFalcon) motors.inputs = 0x70;  // homed
  }

  std::unique_ptr<ForceBoard> board() {
    if (kind == ForceKind::kMouse)
      return std::make_unique<MouseBoard>(
          "mouse",
          std::make_unique<EmulatedTransport>(std::make_unique<EmulatedMouse>(recorded), wire));
    if (kind == ForceKind::kInverse3)
      return std::make_unique<Inverse3Board>(
          "inverse3", "",
          std::make_unique<EmulatedTransport>(std::make_unique<EmulatedInverse3>(recorded), wire));
    if (kind == ForceKind::kFalcon)
      return std::make_unique<FalconBoard>(
          "falcon", std::make_unique<EmulatedTransport>(
                        std::make_unique<EmulatedFalcon>(recorded, memory), wire));
    return std::make_unique<ForceFeedbackBoard>(
        "ff", profile,
        std::make_unique<EmulatedTransport>(std::make_unique<EmulatedForceFeedback>(recorded),
                                            wire),
        ForceFeedbackBoard::Updates::kInCycle);
  }
  static BoardSettings settings(bool threaded) {
    BoardSettings settings;
    settings.threaded = threaded;
    return settings;
  }
  std::unique_ptr<LinkedForce> linked(bool threaded = false) {
    return std::make_unique<LinkedForce>(board(), settings(threaded));
  }
  std::unique_ptr<ForceGrip> grip() {
    return std::make_unique<ForceGrip>(board(), settings(false));
  }

  /// Number of exchanges in which it communicates with the device once.
  int cycles() const {
    if (kind == ForceKind::kInverse3 || kind == ForceKind::kFalcon) return 1;
    return kind == ForceKind::kMouse ? 4 : ForceFeedbackBoard::kUpdate_ms;
  }
  /// Largest error of a digit of the recorded motors, in a middle place: half a digit of each of
  /// the Falcon's motors, 0.05 mN m, at some 44 mm/rad; others round once.
  int rounding() const { return kind == ForceKind::kFalcon ? 3 : 1; }

  const ForceKind kind;
  const Profile profile = load_profile("spidar-g6x3-v2-r");
  MotorBench motors;
  RecordedMotors recorded{motors};
  FalconMemory memory;
  std::shared_ptr<EmulatedWire> wire = std::make_shared<EmulatedWire>();
};

}  // namespace spidar::test
