// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The emulated Novint Falcon.
#pragma once

#include <array>

#include <Eigen/Core>

#include "spidar/devices/falcon/packets.h"
#include "spidar/link/emulated_transport.h"

namespace spidar::emulated {

/// Its digits are the force on the hand in millinewtons, right, up and towards the viewer; its
/// counts are the position of the grip in micrometres, and its inputs buttons (bits 0–3) and the
/// encoders whose marks have been passed (bits 4–6). Nothing has friction or weight. Any firmware
/// will do. Each answer comes in three packets: only status bytes, as when the chip's timer is
/// faster than the firmware, and two parts.
class Falcon final : public Board {
 public:
  static constexpr uint16_t kHomed = 0x70;  ///< inputs: every encoder has passed its mark

  using Board::Board;

  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;
  bool control(const VendorRequest& request) noexcept override;
  void remember(Memory& memory) noexcept override { memory_ = &memory; }

 private:
  void hello(uint8_t byte) noexcept;
  void load(uint8_t byte) noexcept;
  void run(uint8_t byte) noexcept;
  void handle(const falcon::Command& command) noexcept;
  void answer(ByteView bytes) noexcept;
  bool feed(uint8_t byte, size_t length) noexcept;

  Memory own_memory_{{true}, {0}};
  Memory* memory_ = &own_memory_;
  Eigen::Vector3d angles_rad_ = Eigen::Vector3d::Constant(falcon::kAngleAtZero_rad);
  bool loader_ = false;  ///< started by toggling DTR, until the line is fast
  bool takes_firmware_ = false;
  falcon::Packet packet_{};  ///< the one that is being received
  size_t taken_ = 0;
  std::array<uint8_t, 256> answer_{};  ///< bytes that have not been read yet
  size_t due_ = 0;
  bool timer_first_ = false;  ///< the next packet has only status bytes
};

}  // namespace spidar::emulated
