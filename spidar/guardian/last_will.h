// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a guardian sends to a board when its host cannot, and how the two speak.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spidar {

/// Packets of one connection that take its motors to zero. Plain bytes: it goes through a socket to
/// another program, together with the device's file.
struct LastWill {
  enum class Wire : uint32_t {
    kUsb,       ///< usbfs: bulk or interrupt packets to one endpoint
    kTerminal,  ///< a file that packets are written to: a tty, or an input device
  };
  static constexpr size_t kMaxPackets = 8;  // as many UART boards as a line has
  static constexpr size_t kMaxLength = 512;
  static constexpr uint32_t kMagic = 0x53504732;  // "SPG2": this layout

  uint32_t magic = kMagic;
  Wire wire = Wire::kUsb;
  uint32_t interface_number = 0;
  uint32_t endpoint = 0;
  uint32_t packets = 0;
  std::array<uint32_t, kMaxPackets> length{};
  std::array<std::array<uint8_t, kMaxLength>, kMaxPackets> packet{};
  /// The device's file, open, and claimed or locked: the guardian gets a descriptor of the same
  /// open file, so that what the host has claimed is the guardian's, too. A number is of one
  /// process only: each has its own.
  int file = -1;
};

/// A host whose motors pull sends a word at least every kBeat_ms. When none has come for
/// kSilence_ms it is taken for stopped, by a signal, a debugger, or a fault of its own: motors that
/// pull then get their zeros.
constexpr int kBeat_ms = 10;
constexpr int kSilence_ms = 50;

/// What a host says to its guardian, one byte a message. Every word but the last has an answer, by
/// which the host knows that its guardian is awake.
enum class HostWord : char {
  kPulling = 'p',    ///< the motors pull: the next word comes soon
  kResting = 'r',    ///< they are at zero: silence is harmless
  kDismissed = 'q',  ///< the will is not to be carried out
};

/// What it answers; first of all that it is ready.
enum class GuardianWord : char {
  kWatching = 'w',
  /// The host was silent, and the zeros are sent. They are sent again every kSilence_ms until the
  /// guardian is dismissed: a host that goes on may have old volts to send before it hears of this.
  kZeroed = 'z',
};

}  // namespace spidar
