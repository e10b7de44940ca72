// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The boards of an emulated USB, in memory that processes can share.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "spidar/device.h"
#include "spidar/link/emulated_transport.h"
#include "tests/emulated_bus/evdev_port.h"
#include "tests/emulated_bus/exported.h"

namespace spidar {
struct DeviceKind;
}

namespace spidar::test {

/// One port of the bus and the device in it. Any process may change any member at any time.
struct UsbPort {
  std::atomic<size_t> kind{0};  ///< which of usb_kinds(), from 1; 0: nothing is plugged in
  std::atomic<int> address{0};  ///< a new one every time something is plugged in
  std::array<char, 32> serial{};

  std::array<std::atomic<int>, 8> digit{};      ///< digits of the D/A; mouse, Falcon: mN
  std::array<std::atomic<int32_t>, 8> count{};  ///< counts of the encoders; Falcon: µm
  std::atomic<uint16_t> inputs{0};   ///< bits 4–7: rotary switch; or see emulated::Falcon
  std::atomic<uint64_t> updates{0};  ///< how often the digits were set

  /// Applied to all transfers until it is changed. kGone is reserved for unplug().
  std::atomic<LinkFault> fault{LinkFault::kNone};
  std::atomic<bool> forbidden{false};   ///< open() gives EACCES
  std::atomic<bool> has_driver{false};  ///< a kernel driver that must be detached first
  std::atomic<uint64_t> halts_cleared{0};
  emulated::Memory memory;

  bool at_rest() const {
    for (const auto& d : digit)
      if (d != 0) return false;
    return true;
  }
};

constexpr size_t kPorts = 4;

/// An open device file, shared by all processes that have a descriptor of it: a socket, identified
/// by its inode.
struct SharedFile {
  std::atomic<uint64_t> inode{0};
  std::atomic<size_t> port{0};
  std::atomic<int> address{0};
  std::atomic<bool> claimed{false};
};

constexpr size_t kSharedFiles = 64;

/// What plug_in does to the board in port 0 and to the grip on its strings.
struct Rehearsal {
  std::array<char, 16> board{};               ///< DeviceKind::board, to plug it in again
  std::atomic<int> strings{0};                ///< of the grip; 0: there is none
  std::atomic<unsigned> broken{0};            ///< bit i: string i
  std::atomic<int> restarts{0};               ///< how often the board was without power
  std::atomic<bool> stopped{false};           ///< the emergency stop has cut the motors' supply
  std::atomic<bool> moves_about{false};       ///< the hand, in all directions
  std::array<std::atomic<int>, 3> hand_um{};  ///< where it holds the grip else
  std::atomic<int> moves{0};                  ///< how often it was told to move
  std::atomic<int> arrived{0};  ///< the last of these after which the grip stands still
};

struct BusState {
  std::atomic<int> last_address{0};
  std::array<UsbPort, kPorts> port;
  std::atomic<size_t> files_opened{0};
  std::array<SharedFile, kSharedFiles> file;  ///< the latest ones
  std::array<EvdevPort, kEvdevPorts> evdev;
  Rehearsal rehearsal;
};

/// The bus of this process. If $SPIDAR_EMULATED_BUS is the name of a file, which is created if
/// necessary, the bus is shared with all processes that have the same value. If it is "sh4" or
/// another DeviceKind::board on USB, the process has a bus of its own with such a board; "stick",
/// "wheel" or "pad", with such an input device. Without it, the process has an empty bus of its
/// own.
BUS_API BusState& bus();

/// Adds the device with this DeviceKind::board to the list of the bus, as 1-1, 1-2, …, at rest.
/// Throws std::invalid_argument if there is none on USB.
BUS_API UsbPort& plug(size_t port, std::string_view board, const char* serial = "");

/// What is plugged in there; null when nothing is.
const DeviceKind* kind_in(const UsbPort& port);

/// Pulls the device out. Pending transfers fail with `errno_first` (EPROTO is common) or, if that
/// is zero, with ESHUTDOWN; later ones with ENODEV.
BUS_API void unplug(size_t port, int errno_first = 0);

/// Unplugs everything and resets the state.
BUS_API void clear_bus();

}  // namespace spidar::test
