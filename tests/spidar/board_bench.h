// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Boards on an emulated wire.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "spidar/boards/cyverse_board.h"
#include "spidar/boards/link_thread.h"
#include "spidar/boards/uart_board.h"
#include "spidar/emulation/emulated_boards.h"
#include "spidar/emulation/emulated_transport.h"
#include "spidar/session/haptic_session.h"
#include "tests/support/recorded_motors.h"

namespace spidar::test {

enum class Kind { kSh4, kSimple, kUart };

inline std::string name_of(Kind kind) {
  constexpr const char* kNames[] = {"sh4", "simple", "uart"};
  return kNames[static_cast<int>(kind)];
}

struct BoardBench {
  explicit BoardBench(Kind of) : kind(of) {}

  std::unique_ptr<Transport> transport_to(std::unique_ptr<EmulatedBoard> emulated) {
    return std::make_unique<EmulatedTransport>(std::move(emulated), wire);
  }

  std::unique_ptr<Board> board() {
    switch (kind) {
      case Kind::kSh4:
        return std::make_unique<Sh4Board>("sh4", profile,
                                          transport_to(std::make_unique<EmulatedSh4>(recorded)));
      case Kind::kSimple:
        return std::make_unique<SimpleBoard>(
            "simple", profile, transport_to(std::make_unique<EmulatedSimple>(recorded)));
      case Kind::kUart:
        break;
    }
    constexpr uart_motor::BoardInfo kB3M{5, 1, 4, 4, 0, 0};
    std::vector<std::unique_ptr<Transport>> lines;
    lines.push_back(transport_to(std::make_unique<EmulatedUart>(
        recorded, std::vector<EmulatedUart::Station>{{0, kB3M}, {3, kB3M}})));
    return std::make_unique<UartBoard>("uart", profile, std::move(lines));
  }

  std::unique_ptr<BoardDevice> device(bool threaded = false,
                                      CountZero count_zero = CountZero::kFirstOpen) {
    BoardSettings settings;
    settings.threaded = threaded;
    settings.count_zero = count_zero;
    return std::make_unique<BoardDevice>(board(), settings);
  }

  const Kind kind;
  /// For the D/A of the boards: up to 9.867 V, or 3.3 V.
  const Profile profile = load_profile(kind == Kind::kUart ? "spidar-g6x" : "spidar-g6x3-v2-r");
  MotorBench motors;
  RecordedMotors recorded{motors};
  std::shared_ptr<EmulatedWire> wire = std::make_shared<EmulatedWire>();
};

inline MotorVolts all_volts(double volt) {
  MotorVolts volts;
  volts.volt.fill(volt);
  return volts;
}

/// Runs a session without a thread until the strings are energised.
inline void tick_until_running(HapticSession& session) {
  int64_t now_ns = 0;
  while (session.loop().snapshot().last.device != DeviceState::kRunning) {
    now_ns += kTick_ns;
    session.loop().tick(now_ns, now_ns);
  }
}

}  // namespace spidar::test
