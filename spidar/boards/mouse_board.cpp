// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/mouse_board.h"

#include <cmath>
#include <utility>

#include "spidar/boards/opening.h"

namespace spidar {

MouseBoard::MouseBoard(std::string name, const Profile& profile,
                       std::unique_ptr<Transport> transport)
    : name_(std::move(name)), transport_(std::move(transport)) {
  force_per_volt_ = structure_matrix(profile.geometry, {}).topRows<2>();
  for (int i = 0; i < kMaxStrings; ++i) {
    const auto k = static_cast<size_t>(i);
    const StringDrive& drive = profile.drives[k];
    force_per_volt_.col(i) *= drive.newtons_per_volt * drive.motor_sign;
    if (drive.metres_per_count > 0)
      home_count_[k] = static_cast<int32_t>(
          std::lround(-drive.encoder_sign * drive.home_offset_m / drive.metres_per_count));
  }
}

void MouseBoard::open() {
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
    transport_->close();
    throw DeviceError(name_ +
                      ": the device with the id 04d8:003f is no SPIDAR-mouse: asked for its "
                      "state, the answer is " +
                      to_string(fault) + "; that id is shared by many devices, unplug others");
  }
  mouse::encode_start(out_);
  transport_->exchange({out_}, {}, monotonic_now_ns() + kSecond_ns / 10);
  started_ = true;
  cycle_ = 0;
}

void MouseBoard::close() noexcept {
  if (started_) {
    const int64_t deadline_ns = monotonic_now_ns() + kSecond_ns / 10;
    mouse::encode_force({}, out_);
    transport_->exchange({out_}, {}, deadline_ns);
    mouse::encode_stop(out_);
    transport_->exchange({out_}, {}, deadline_ns);
    started_ = false;
  }
  transport_->close();
}

LinkFault MouseBoard::cycle(const MotorVolts& volts, DeviceReading& reading,
                            int64_t deadline_ns) noexcept {
  if (cycle_++ % kCyclesPerReport == 0) {
    StringVector volt;
    for (int i = 0; i < kMaxStrings; ++i) volt[i] = volts.volt[static_cast<size_t>(i)];
    const Eigen::Vector2d force_N = force_per_volt_ * volt;
    mouse::encode_force({force_N.x(), force_N.y()}, out_);
    const Transfer transfer = transport_->exchange({out_}, {}, deadline_ns);
    if (transfer.fault != LinkFault::kNone) return transfer.fault;
  }
  reading.count = home_count_;
  reading.inputs = 0;
  reading.encoders = false;
  return LinkFault::kNone;
}

std::vector<LastWill> MouseBoard::last_wills() const {
  mouse::Report zero, stop;
  mouse::encode_force({}, zero);
  mouse::encode_stop(stop);
  return wills(*transport_, {zero, stop});
}

}  // namespace spidar
