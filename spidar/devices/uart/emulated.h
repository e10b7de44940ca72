// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "spidar/devices/uart/packets.h"
#include "spidar/link/emulated_transport.h"

namespace spidar::emulated {

/// The emulated UART motor boards. They accept the bytes of the line in pieces of any size, as the
/// interrupts of the real boards do.
class Uart final : public Board {
 public:
  struct Station {
    int id = 0;
    uart_motor::BoardInfo info;
  };

  /// `motors` are numbered in the order of the stations.
  Uart(std::shared_ptr<Motors> motors, std::vector<Station> stations)
      : Board(std::move(motors)), stations_(std::move(stations)) {}

  void receive(ByteView bytes) noexcept override {
    for (size_t i = 0; i < bytes.size; ++i) {
      if (!station_) {
        begin(bytes.u8(i));
      } else {
        command_[taken_++] = bytes.u8(i);
      }
      if (station_ && taken_ == length_) end_of_command();
    }
  }
  size_t reply(MutableBytes bytes) noexcept override {
    const size_t length = std::min(bytes.size, due_);
    std::copy_n(reply_.begin(), length, bytes.data);
    std::copy(reply_.begin() + static_cast<long>(length), reply_.begin() + static_cast<long>(due_),
              reply_.begin());
    due_ -= length;
    return length;
  }

 private:
  /// Handles a byte between commands: a zero only gives time for a reply; any other is a header.
  void begin(uint8_t header) noexcept {
    if (header == 0) return;
    first_ = 0;
    for (const Station& station : stations_) {
      const auto lengths = uart_motor::command_lengths(station.info.motors, station.info.forces);
      const size_t command = header >> 3;
      if (station.id == (header & 7) && command < lengths.size()) {
        station_ = &station;
        length_ = lengths[command];
        command_[0] = header;
        taken_ = 1;
        return;
      }
      first_ += station.info.motors;
    }
  }
  void end_of_command() noexcept {
    const Station& station = *station_;
    station_ = nullptr;
    const ByteView command(command_.data(), taken_);
    std::array<int, uart_motor::kMaxMotors> digits{};
    if (command.u8(0) == uart_motor::header(station.id, uart_motor::Command::kBoardInfo)) {
      std::array<uint8_t, uart_motor::kInfoLength> info{};
      uart_motor::encode_info(station.info, station.id, info);
      append_reply(info);
    } else if (uart_motor::decode_current(command, station.id, station.info, digits)) {
      const size_t motors = std::min<size_t>(station.info.motors, kMaxStrings - first_);
      std::copy_n(digits.begin(), motors, digits_.begin() + static_cast<long>(first_));
      motors_->set_outputs(digits_);
      const std::array<int32_t, kMaxStrings> counts = motors_->counts();
      uart_motor::Reading reading;
      for (size_t i = 0; i < motors; ++i) {
        reading.position[i] = static_cast<uint16_t>(counts[first_ + i]);
      }
      std::array<uint8_t, uart_motor::kMaxReplyLength> reply{};
      const size_t length = uart_motor::encode_reading(reading, station.id, station.info, reply);
      append_reply({reply.data(), length});
    }
  }
  void append_reply(ByteView reply) noexcept {
    const size_t length = std::min(reply.size, reply_.size() - due_);
    std::copy_n(reply.data, length, reply_.begin() + static_cast<long>(due_));
    due_ += length;
  }

  const std::vector<Station> stations_;
  std::array<int, kMaxStrings> digits_{};
  const Station* station_ = nullptr;
  size_t first_ = 0;  ///< first motor of the station
  std::array<uint8_t, 256> command_{};
  size_t length_ = 0;  ///< length of the whole command
  size_t taken_ = 0;
  // Replies that have not been read yet.
  std::array<uint8_t, 1024> reply_{};
  size_t due_ = 0;
};

}  // namespace spidar::emulated
