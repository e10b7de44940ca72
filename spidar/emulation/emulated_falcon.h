// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An emulated Novint Falcon behind its FTDI chip.
#pragma once

#include <array>
#include <atomic>

#include <Eigen/Core>

#include "spidar/emulation/emulated_board.h"
#include "spidar/protocols/novint_falcon.h"

namespace spidar {

/// What stays in the device while programs come and go. Starts as after plugging in.
struct FalconMemory {
  std::atomic<bool> loaded{false};  ///< with its firmware
  std::atomic<uint16_t> baud{0};    ///< divisor
};

/// Its digits are the force on the hand in millinewtons, right, up and towards the viewer; its
/// counts are the position of the grip in micrometres, and its inputs buttons (bits 0–3) and the
/// encoders whose marks have been passed (bits 4–6). Nothing has friction or weight. Any firmware
/// will do. Each answer comes in three packets: only status bytes, as when the chip's timer is
/// faster than the firmware, and two parts.
class EmulatedFalcon final : public EmulatedBoard {
 public:
  /// Both must outlive the board.
  EmulatedFalcon(EmulatedMotors& motors, FalconMemory& memory) noexcept
      : motors_(motors), memory_(memory) {}

  void receive(ByteView bytes) noexcept override;
  size_t reply(MutableBytes bytes) noexcept override;
  bool control(const VendorRequest& request) noexcept override;

 private:
  void hello(uint8_t byte) noexcept;
  void load(uint8_t byte) noexcept;
  void run(uint8_t byte) noexcept;
  void obey(const falcon::Command& command) noexcept;
  void answer(ByteView bytes) noexcept;
  bool feed(uint8_t byte, size_t length) noexcept;

  EmulatedMotors& motors_;
  FalconMemory& memory_;
  Eigen::Vector3d angles_rad_ = Eigen::Vector3d::Constant(falcon::kAngleAtZero_rad);
  bool loader_ = false;  ///< started by toggling DTR, until the line is fast
  bool takes_firmware_ = false;
  falcon::Packet packet_{};  ///< that is being received
  size_t taken_ = 0;
  std::array<uint8_t, 256> answer_{};  ///< that has not been read yet
  size_t due_ = 0;
  bool timer_first_ = false;  ///< the next packet has only status bytes
};

}  // namespace spidar
