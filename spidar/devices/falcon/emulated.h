// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>

#include <Eigen/Core>

#include "spidar/devices/falcon/packets.h"
#include "spidar/link/emulated_transport.h"

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
  bool loader_ = false;  ///< whether the loader runs; toggling DTR starts it, and kRunBaud ends it
  bool takes_firmware_ = false;
  falcon::Packet packet_{};  ///< the packet that is being received
  size_t taken_ = 0;
  std::array<uint8_t, 256> answer_{};  ///< the bytes that have not been read yet
  size_t due_ = 0;
  bool timer_first_ = false;  ///< whether the next packet has only status bytes
};

}  // namespace spidar::emulated
