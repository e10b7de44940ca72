// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

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

  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;

 private:
  void begin(uint8_t header) noexcept;
  void end_of_command() noexcept;
  void append_reply(ByteView reply) noexcept;

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
