// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/emulation/wire_simulation.h"

#include <utility>
#include <vector>

#include "spidar/boards/board_parts.h"
#include "spidar/boards/cyverse_board.h"
#include "spidar/boards/link_thread.h"
#include "spidar/boards/uart_board.h"
#include "spidar/emulation/emulated_boards.h"
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

/// Owns the device to which its transport's board is connected.
class WireSimulation final : public Device {
 public:
  WireSimulation(std::unique_ptr<EmulatedMotors> motors, std::unique_ptr<Board> board)
      : motors_(std::move(motors)), device_(std::move(board), settings_of_simulation()) {}

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

BoardSettings settings_of_simulation() {
  BoardSettings settings;
  settings.count_zero = CountZero::kNever;
  settings.guardian = false;
  settings.threaded = false;
  return settings;
}

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
    return nullptr;
  }
  return std::make_unique<WireSimulation>(std::move(motors), std::move(board));
}

}  // namespace spidar
