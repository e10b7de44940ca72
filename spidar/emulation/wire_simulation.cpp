// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/emulation/wire_simulation.h"

#include <utility>
#include <vector>

#include "spidar/boards/board_device.h"
#include "spidar/boards/digits.h"
#include "spidar/boards/falcon_board.h"
#include "spidar/boards/force_feedback_board.h"
#include "spidar/boards/force_grip.h"
#include "spidar/boards/inverse3_board.h"
#include "spidar/boards/mouse_board.h"
#include "spidar/boards/sh4_board.h"
#include "spidar/boards/simple_board.h"
#include "spidar/boards/uart_board.h"
#include "spidar/emulation/emulated_force_feedback.h"
#include "spidar/emulation/emulated_inverse3.h"
#include "spidar/emulation/emulated_uart.h"
#include "spidar/emulation/emulated_usb.h"
#include "spidar/emulation/held_falcon.h"
#include "spidar/emulation/spring_hand.h"
#include "spidar/simulation/simulated_device.h"

namespace spidar {
namespace {

/// The simulated device's motors and encoders, connected to a board.
class SimulatedMotors final : public EmulatedMotors {
 public:
  SimulatedMotors(const Profile& profile, const DacScale& dac, const SimulatedMechanics& mechanics)
      : device_(profile, SimulatedDevice::Time::kClock,
                mechanics.model.value_or(grip_model_of(profile)), mechanics.clock),
        dac_(dac) {
    device_.open();
  }
  ~SimulatedMotors() override { device_.close(); }

  void put_out(const std::array<int, kMaxStrings>& digits) noexcept override {
    MotorVolts volts;
    for (size_t i = 0; i < digits.size(); ++i) volts.volt[i] = dac_.volt(digits[i]);
    device_.exchange(volts, reading_);
  }
  std::array<int32_t, kMaxStrings> counts() noexcept override { return reading_.count; }

 private:
  SimulatedDevice device_;
  const DacScale dac_;
  DeviceReading reading_;
};

/// What takes a force has neither strings nor encoders here: its force has no effect.
class NoMotors final : public EmulatedMotors {
 public:
  void put_out(const std::array<int, kMaxStrings>&) noexcept override {}
  std::array<int32_t, kMaxStrings> counts() noexcept override { return {}; }
};

/// In a hand.
class HeldInverse3 final : public EmulatedBoard {
 public:
  void receive(ByteView bytes) noexcept override { board_.receive(bytes); }
  size_t reply(MutableBytes bytes) noexcept override { return board_.reply(bytes); }

 private:
  SpringHand hand_;
  EmulatedInverse3 board_{hand_};
};

/// Without a thread and a guardian.
BoardSettings alone() {
  BoardSettings settings;
  // The simulated user begins at the centre, from which the profile's home offsets are counted.
  settings.count_zero = CountZero::kNever;
  settings.guardian = false;
  settings.threaded = false;
  return settings;
}

/// Owns the device to which its transport's board is connected.
class WireSimulation final : public Device {
 public:
  WireSimulation(std::unique_ptr<EmulatedMotors> motors, std::unique_ptr<Board> board)
      : motors_(std::move(motors)), device_(std::move(board), alone()) {}

  void open() override { device_.open(); }
  ExchangeStatus exchange(const MotorVolts& volts, DeviceReading& reading) noexcept override {
    return device_.exchange(volts, reading);
  }
  void close() noexcept override { device_.close(); }
  std::string description() const override { return device_.description(); }
  const std::string& name() const noexcept override { return device_.name(); }
  LinkHealth health() const noexcept override { return device_.health(); }

 private:
  const std::unique_ptr<EmulatedMotors> motors_;
  BoardDevice device_;
};

}  // namespace

std::unique_ptr<Device> make_wire_simulation(const std::string& kind, const Profile& profile,
                                             std::shared_ptr<EmulatedWire> wire,
                                             const SimulatedMechanics& mechanics) {
  const std::string name = "sim:" + kind;
  const auto transport_to = [&wire](std::unique_ptr<EmulatedBoard> board) {
    return std::make_unique<EmulatedTransport>(std::move(board), wire);
  };
  std::unique_ptr<EmulatedMotors> motors;
  std::unique_ptr<Board> board;
  if (kind == "sh4") {
    motors = std::make_unique<SimulatedMotors>(profile, unipolar_dac(profile), mechanics);
    board = std::make_unique<Sh4Board>(name, profile,
                                       transport_to(std::make_unique<EmulatedSh4>(*motors)));
  } else if (kind == "simple") {
    motors = std::make_unique<SimulatedMotors>(profile, unipolar_dac(profile), mechanics);
    board = std::make_unique<SimpleBoard>(name, profile,
                                          transport_to(std::make_unique<EmulatedSimple>(*motors)));
  } else if (kind == "uart") {
    // Two boards of four motors, like the published pair of a SPIDAR-G.
    constexpr uart_motor::BoardInfo kB3M{5, 1, 4, 4, 0, 0};
    motors = std::make_unique<SimulatedMotors>(profile, uart_dac(), mechanics);
    std::vector<std::unique_ptr<Transport>> lines;
    lines.push_back(transport_to(std::make_unique<EmulatedUart>(
        *motors, std::vector<EmulatedUart::Station>{{0, kB3M}, {1, kB3M}})));
    board = std::make_unique<UartBoard>(name, profile, std::move(lines));
  } else {
    throw DeviceError("unknown simulated board \"" + kind +
                      "\"; known are: sim:sh4, sim:simple, sim:uart, sim:mouse, sim:ff, "
                      "sim:inverse3, sim:falcon");
  }
  return std::make_unique<WireSimulation>(std::move(motors), std::move(board));
}

std::unique_ptr<Grip> make_grip_simulation(const std::string& kind, const Profile& profile) {
  static NoMotors motors;  // has nothing that could be shared
  const auto transport_to = [](std::unique_ptr<EmulatedBoard> board) {
    return std::make_unique<EmulatedTransport>(std::move(board), std::make_shared<EmulatedWire>());
  };
  const std::string name = "sim:" + kind;
  std::unique_ptr<ForceBoard> board;
  if (kind == "mouse")
    board =
        std::make_unique<MouseBoard>(name, transport_to(std::make_unique<EmulatedMouse>(motors)));
  else if (kind == "ff")
    board = std::make_unique<ForceFeedbackBoard>(
        name, profile, transport_to(std::make_unique<EmulatedForceFeedback>(motors)),
        ForceFeedbackBoard::Updates::kInCycle);
  else if (kind == "inverse3")
    board =
        std::make_unique<Inverse3Board>(name, "", transport_to(std::make_unique<HeldInverse3>()));
  else if (kind == "falcon")
    board = std::make_unique<FalconBoard>(name, transport_to(std::make_unique<HeldFalcon>()));
  else
    return nullptr;
  return std::make_unique<ForceGrip>(std::move(board), alone());
}

}  // namespace spidar
