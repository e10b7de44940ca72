// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <array>

#include <Eigen/LU>

#include "spidar/devices/falcon/kinematics.h"
#include "spidar/devices/falcon/packets.h"
#include "spidar/link/spring_hand.h"

namespace spidar::emulated {

/// The emulated Novint Falcon. Its digits are the force on the hand in millinewtons (right, up,
/// towards the viewer); its counts are the position of the grip in micrometres; its inputs are the
/// buttons (bits 0–3) and the encoders whose marks have been passed (bits 4–6). The model has
/// neither friction nor weight, and accepts any firmware. Each answer comes in three packets: one
/// of status bytes only, as when the chip's timer is faster than the firmware, and two parts.
class Falcon final : public Board {
 public:
  static constexpr uint16_t kHomed = 0x70;  ///< inputs: every encoder has passed its mark

  using Board::Board;

  void receive(ByteView bytes) noexcept override {
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
  size_t reply(MutableBytes bytes) noexcept override {
    if (due_ == 0 || bytes.size <= ftdi::kStatusSize) return 0;
    bytes.put_u16(0, 0x6001);  // modem and line status of an idle chip
    const size_t part = memory_->baud == falcon::kRunBaud ? kPart : falcon::kPieceSize;
    const size_t length = timer_first_ ? 0 : std::min({due_, part, bytes.size - ftdi::kStatusSize});
    timer_first_ = false;
    std::copy_n(answer_.begin(), length, bytes.data + ftdi::kStatusSize);
    std::copy(answer_.begin() + static_cast<long>(length),
              answer_.begin() + static_cast<long>(due_), answer_.begin());
    due_ -= length;
    return ftdi::kStatusSize + length;
  }
  bool control(const VendorRequest& request) noexcept override {
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
  void remember(Memory& memory) noexcept override { memory_ = &memory; }

 private:
  /// Bytes in a packet of the running firmware, whose answers come in two parts.
  static constexpr size_t kPart = 9;

  static bool is(const VendorRequest& request, const VendorRequest& other) noexcept {
    return request.request == other.request && request.value == other.value;
  }

  /// Returns the force of these motors on the hand, N; zero where the arms determine no force.
  static Eigen::Vector3d force_N(const std::array<int, 3>& digit, const Eigen::Vector3d& angles_rad,
                                 const Eigen::Vector3d& position_m) noexcept {
    const auto jacobian = falcon::jacobian(angles_rad, position_m);
    if (!jacobian) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d torque_Nm =
        Eigen::Vector3d(digit[0], digit[1], digit[2]) / falcon::kDigitsPerNm;
    return jacobian->transpose().inverse() * torque_Nm;
  }

  void hello(uint8_t byte) noexcept {
    if (!loader_ || !feed(byte, falcon::kHello.size())) return;
    if (std::equal(falcon::kHello.begin(), falcon::kHello.end(), packet_.begin())) {
      answer(falcon::kHelloAnswer);
    }
  }
  /// Echoes every byte; the bytes after the first one are the firmware.
  void load(uint8_t byte) noexcept {
    if (!loader_) return;
    answer({&byte, 1});
    if (takes_firmware_) memory_->loaded = true;
    takes_firmware_ = true;
  }
  void run(uint8_t byte) noexcept {
    falcon::Command command;
    if (!memory_->loaded || !feed(byte, falcon::kPacketSize)) return;
    if (falcon::decode_command(packet_, command)) handle(command);
  }
  void handle(const falcon::Command& command) noexcept {
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
  void answer(ByteView bytes) noexcept {
    timer_first_ = due_ == 0;
    const size_t length = std::min(bytes.size, answer_.size() - due_);
    std::copy_n(bytes.data, length, answer_.begin() + static_cast<long>(due_));
    due_ += length;
  }
  bool feed(uint8_t byte, size_t length) noexcept {
    packet_[taken_++] = byte;
    if (taken_ < length) return false;
    taken_ = 0;
    return true;
  }

  Memory own_memory_{{true}, {0}};
  Memory* memory_ = &own_memory_;
  Eigen::Vector3d angles_rad_ = Eigen::Vector3d::Constant(falcon::kAngleAtZero_rad);
  bool loader_ = false;  ///< whether the loader runs; toggling DTR starts it, and kRunBaud ends it
  bool takes_firmware_ = false;
  falcon::Packet packet_{};  ///< the packet that is being received
  size_t taken_ = 0;
  std::array<uint8_t, 256> answer_{};  ///< the bytes that have not been read yet
  size_t due_ = 0;
  bool timer_first_ = false;  ///< whether the next packet has only status bytes
};

}  // namespace spidar::emulated
