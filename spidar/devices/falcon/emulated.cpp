// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/falcon/emulated.h"

#include <algorithm>

#include <Eigen/LU>

#include "spidar/devices/falcon/kinematics.h"
#include "spidar/link/spring_hand.h"

namespace spidar::emulated {
namespace {

/// Bytes in a packet of the running firmware, whose answers come in two parts.
constexpr size_t kPart = 9;

bool is(const VendorRequest& request, const VendorRequest& other) noexcept {
  return request.request == other.request && request.value == other.value;
}

/// Returns the force of these motors on the hand, N; zero where the arms determine no force.
Eigen::Vector3d force_N(const std::array<int, 3>& digit, const Eigen::Vector3d& angles_rad,
                        const Eigen::Vector3d& position_m) noexcept {
  const auto jacobian = falcon::jacobian(angles_rad, position_m);
  if (!jacobian) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d torque_Nm =
      Eigen::Vector3d(digit[0], digit[1], digit[2]) / falcon::kDigitsPerNm;
  return jacobian->transpose().inverse() * torque_Nm;
}

}  // namespace

bool Falcon::control(const VendorRequest& request) noexcept {
  if (request.request == ftdi::kSetBaud) {
    memory_->baud = request.value;
    loader_ = loader_ && request.value != falcon::kRunBaud;
    taken_ = 0;
  } else if (is(request, ftdi::kDtrHigh) && memory_->baud == falcon::kHelloBaud) {
    loader_ = true;
    takes_firmware_ = memory_->loaded = false;
  } else if (is(request, ftdi::kDropReceived)) {
    due_ = 0;
  }
  return true;
}

void Falcon::receive(ByteView bytes) noexcept {
  for (size_t i = 0; i < bytes.size; ++i) {
    if (memory_->baud == falcon::kHelloBaud) {
      hello(bytes.u8(i));
    } else if (memory_->baud == falcon::kLoadBaud) {
      load(bytes.u8(i));
    } else if (memory_->baud == falcon::kRunBaud) {
      run(bytes.u8(i));
    }
  }
}

bool Falcon::feed(uint8_t byte, size_t length) noexcept {
  packet_[taken_++] = byte;
  if (taken_ < length) return false;
  taken_ = 0;
  return true;
}

void Falcon::hello(uint8_t byte) noexcept {
  if (!loader_ || !feed(byte, falcon::kHello.size())) return;
  if (std::equal(falcon::kHello.begin(), falcon::kHello.end(), packet_.begin())) {
    answer(falcon::kHelloAnswer);
  }
}

/// Echoes every byte; the bytes after the first one are the firmware.
void Falcon::load(uint8_t byte) noexcept {
  if (!loader_) return;
  answer({&byte, 1});
  if (takes_firmware_) memory_->loaded = true;
  takes_firmware_ = true;
}

void Falcon::run(uint8_t byte) noexcept {
  falcon::Command command;
  if (!memory_->loaded || !feed(byte, falcon::kPacketSize)) return;
  if (falcon::decode_command(packet_, command)) handle(command);
}

void Falcon::handle(const falcon::Command& command) noexcept {
  const Eigen::Vector3d at_m = position_m(*motors_);
  // When the position is out of reach, the grip stays where it was.
  angles_rad_ = falcon::arm_angles(at_m).value_or(angles_rad_);
  set_force_N(*motors_, force_N(command.digit, angles_rad_, at_m));
  falcon::Reading reading;
  for (size_t i = 0; i < 3; ++i) {
    reading.count[i] = falcon::count_at(angles_rad_[static_cast<Eigen::Index>(i)]);
  }
  const uint16_t inputs = motors_->inputs();
  reading.buttons = inputs & 0xF;
  if (command.homing) reading.homed = inputs >> 4 & 7;
  falcon::Packet packet;
  falcon::encode_reading(reading, packet);
  answer(packet);
}

void Falcon::answer(ByteView bytes) noexcept {
  timer_first_ = due_ == 0;
  const size_t length = std::min(bytes.size, answer_.size() - due_);
  std::copy_n(bytes.data, length, answer_.begin() + static_cast<long>(due_));
  due_ += length;
}

size_t Falcon::reply(MutableBytes bytes) noexcept {
  if (due_ == 0 || bytes.size <= ftdi::kStatusSize) return 0;
  bytes.put_u16(0, 0x6001);  // modem and line status of an idle chip
  const size_t part = memory_->baud == falcon::kRunBaud ? kPart : falcon::kPieceSize;
  const size_t length = timer_first_ ? 0 : std::min({due_, part, bytes.size - ftdi::kStatusSize});
  timer_first_ = false;
  std::copy_n(answer_.begin(), length, bytes.data + ftdi::kStatusSize);
  std::copy(answer_.begin() + static_cast<long>(length), answer_.begin() + static_cast<long>(due_),
            answer_.begin());
  due_ -= length;
  return ftdi::kStatusSize + length;
}

}  // namespace spidar::emulated
