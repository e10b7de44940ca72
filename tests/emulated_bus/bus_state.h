// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The boards of an emulated USB, in memory that processes can share.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "spidar/transports/link_fault.h"
#include "tests/emulated_bus/evdev_port.h"
#include "tests/emulated_bus/exported.h"

namespace spidar::test {

enum class UsbKind : int { kNone, kSh4, kSimple, kMouse };

/// One socket of the bus and what is plugged into it. All of it may be changed at any time, by any
/// process.
struct UsbPort {
  std::atomic<UsbKind> kind{UsbKind::kNone};
  std::atomic<int> address{0};  ///< a new one every time something is plugged in
  std::array<char, 32> serial{};

  std::array<std::atomic<int>, 8> digit{};      ///< what the D/A puts out; mouse: mN, x and y
  std::array<std::atomic<int32_t>, 8> count{};  ///< what the encoders say
  std::atomic<uint16_t> inputs{0};              ///< bits 4–7: rotary switch
  std::atomic<uint64_t> updates{0};             ///< how often the digits were set

  /// Of all transfers until it is changed. kGone is for unplug() alone.
  std::atomic<LinkFault> fault{LinkFault::kNone};
  std::atomic<bool> forbidden{false};   ///< open() gives EACCES
  std::atomic<bool> has_driver{false};  ///< a kernel driver that must be detached first
  std::atomic<uint64_t> halts_cleared{0};

  bool at_rest() const {
    for (const auto& d : digit)
      if (d != 0) return false;
    return true;
  }
};

constexpr size_t kPorts = 4;

/// An open device file, as the processes see it that have a descriptor of it: it is a socket, known
/// by its inode.
struct SharedFile {
  std::atomic<uint64_t> inode{0};
  std::atomic<size_t> port{0};
  std::atomic<int> address{0};
  std::atomic<bool> claimed{false};
};

constexpr size_t kSharedFiles = 64;

struct BusState {
  std::atomic<int> last_address{0};
  std::array<UsbPort, kPorts> port;
  std::atomic<size_t> files_opened{0};
  std::array<SharedFile, kSharedFiles> file;  ///< the newest ones
  std::array<EvdevPort, kEvdevPorts> evdev;
};

/// The bus of this process: shared with the processes that have the same $SPIDAR_EMULATED_BUS, a
/// file that is made when it is not there; without, its own. When that is "sh4", "simple" or
/// "mouse", its own with such a board; "stick", "wheel" or "pad", with such an input device.
BUS_API BusState& bus();

/// The device is in the list of the bus from now on, as 1-1, 1-2, …, at rest.
BUS_API UsbPort& plug(size_t port, UsbKind kind, const char* serial = "");

/// Pulls it out. What is in flight fails with `errno_first` (EPROTO is common) or, when that is
/// zero, with ESHUTDOWN; what comes later with ENODEV.
BUS_API void unplug(size_t port, int errno_first = 0);

/// Everything pulled out and forgotten.
BUS_API void clear_bus();

}  // namespace spidar::test
