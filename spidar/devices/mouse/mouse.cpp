// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "spidar/devices/mouse/packets.h"
#include "spidar/link/board_parts.h"
#include "spidar/link/device_kind.h"
#include "spidar/link/emulated_transport.h"

namespace spidar::boards {

/// The SPIDAR-mouse: two force axes. Its grip is always at the centre.
class Mouse final : public OnTransport<ForceBoard> {
 public:
  using OnTransport::OnTransport;

  void open() override {
    transport_->open();
    mouse::encode_query(out_);
    const LinkFault fault = open_exchange(
        [&](int64_t deadline_ns) {
          const Transfer transfer = transport_->exchange({out_}, in_, deadline_ns);
          if (transfer.fault != LinkFault::kNone) return transfer.fault;
          return mouse::is_state({in_.data(), transfer.received}) ? LinkFault::kNone
                                                                  : LinkFault::kWrongReply;
        },
        *transport_);
    if (fault != LinkFault::kNone) {
      throw DeviceError(name_ +
                            ": the device with the id 04d8:003f is no SPIDAR-mouse: asked for its "
                            "state, the answer is " +
                            to_string(fault) + "; that id is shared by many devices, unplug others",
                        DeviceErrorCode::kAbsent);
    }
    mouse::encode_start(out_);
    transport_->exchange({out_}, {}, soon_ns());
    started_ = true;
    cycle_ = 0;
  }
  LinkFault cycle(const ForceOutput& output, ForceReading& reading,
                  int64_t deadline_ns) noexcept override {
    if (cycle_++ % kCyclesPerReport == 0) {
      mouse::encode_force(output.force_N.head<2>(), out_);
      const Transfer transfer = transport_->exchange({out_}, {}, deadline_ns);
      if (transfer.fault != LinkFault::kNone) return transfer.fault;
    }
    reading.position_m.setZero();
    return LinkFault::kNone;
  }
  void close() noexcept override {
    if (started_) {
      const int64_t deadline_ns = soon_ns();
      mouse::encode_force(Eigen::Vector2d::Zero(), out_);
      transport_->exchange({out_}, {}, deadline_ns);
      mouse::encode_stop(out_);
      transport_->exchange({out_}, {}, deadline_ns);
      started_ = false;
    }
    OnTransport::close();
  }
  std::vector<LastWill> last_wills() const override {
    mouse::Report zero, stop;
    mouse::encode_force(Eigen::Vector2d::Zero(), zero);
    mouse::encode_stop(stop);
    return wills(*transport_, {zero, stop});
  }
  std::string description() const override { return transport_->where() + "SPIDAR-mouse"; }
  GripAbilities abilities() const noexcept override { return kAbilities; }

 private:
  /// Period at which the published program sends a force, 4 ms.
  static constexpr int kCyclesPerReport = 4;
  static constexpr GripAbilities kAbilities{.force = {true, true, false},
                                            .torque = false,
                                            .position = {},
                                            .largest_force_N = mouse::kMaxForce_N,
                                            .rate_Hz = 1000 / kCyclesPerReport};

  bool started_ = false;
  int cycle_ = 0;
  mouse::Report out_{};
  mouse::Report in_{};
};

}  // namespace spidar::boards

namespace spidar::emulated {

/// The emulated SPIDAR-mouse. Its digits are the force in millinewtons, x and y.
class Mouse final : public Board {
 public:
  using Board::Board;
  void receive(ByteView bytes) noexcept override {
    mouse::Command command{};
    Eigen::Vector2d force_N;
    if (!mouse::decode_command(bytes, command, force_N)) return;
    if (command == mouse::Command::kQuery) due_ = true;
    if (command == mouse::Command::kStart) started_ = true;
    if (command == mouse::Command::kStop) started_ = false;
    std::array<int, kMaxStrings> milli_N{};
    if (command == mouse::Command::kForce && started_) {
      milli_N[0] = static_cast<int>(std::lround(1000 * force_N.x()));
      milli_N[1] = static_cast<int>(std::lround(1000 * force_N.y()));
    }
    if (command == mouse::Command::kForce || command == mouse::Command::kStop) {
      motors_->set_outputs(milli_N);
    }
  }
  size_t reply(MutableBytes bytes) noexcept override {
    mouse::Report report;
    mouse::encode_state(report);
    return copy_out(report, bytes, due_);
  }

 private:
  bool due_ = false;
  bool started_ = false;
};

}  // namespace spidar::emulated

namespace spidar {

std::vector<DeviceKind> mouse_kinds() {
  return {{.device = "mouse",
           .board = "mouse",
           .title = "SPIDAR-mouse",
           .names = "mouse, mouse:ID",
           .usb = {.vendor = mouse::kVendor,
                   .product = mouse::kProduct,
                   .out = mouse::kEndpointOut,
                   .in = mouse::kEndpointIn,
                   .interrupt = true,
                   .shared = true,
                   .full_speed = true},
           .evidence = "inferred",
           .note = "other devices have this id: it is asked when it is opened",
           .attach = attach<boards::Mouse>,
           .emulate = emulate<emulated::Mouse>}};
}

}  // namespace spidar
