// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Emulated force-feedback devices, in memory that processes can share.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "tests/emulated_bus/exported.h"

namespace spidar::test {

enum class EvdevKind : int {
  kNone,
  kStick,     ///< two axes, FF_CONSTANT, gain, autocentre
  kWheel,     ///< one axis, FF_CONSTANT, autocentre
  kPad,       ///< two axes, FF_RUMBLE only
  kKeyboard,  ///< neither
};

/// An input device, as /dev/input/eventN of its number. Every field may be changed at any time, by
/// any process.
struct EvdevPort {
  struct Effect {
    std::atomic<bool> used{false};
    std::atomic<bool> plays{false};
    std::atomic<int> right{0};   ///< level
    std::atomic<int> up{0};      ///< level
    std::atomic<int> rumble{0};  ///< strength
  };

  std::atomic<EvdevKind> kind{EvdevKind::kNone};
  std::atomic<uint64_t> inode{0};  ///< of its file: another one every time it is plugged in
  /// Where the stick is, −1000 … 1000: to the right, and to the user, as ABS_X and ABS_Y are.
  std::array<std::atomic<int>, 2> axis{};
  std::array<Effect, 4> effect{};
  std::atomic<int> gain{0};
  std::atomic<int> autocentre{0};

  std::atomic<uint64_t> uploads{0};
  std::atomic<uint64_t> unchanged{0};  ///< uploads of what the effect was already
  std::atomic<uint64_t> plays{0};
  std::atomic<int64_t> shortest_ns{0};  ///< between two uploads, of those since it was 0

  std::atomic<int> upload_ms{0};     ///< that the driver takes for an upload
  std::atomic<int> upload_error{0};  ///< errno of every upload; 0: none

 private:
  friend struct EvdevCalls;
  std::atomic<int64_t> last_upload_ns{0};
};

constexpr size_t kEvdevPorts = 4;

/// The device is listed and can be opened from now on, its effects and counters fresh.
BUS_API EvdevPort& plug_evdev(size_t number, EvdevKind kind);

/// Open files of it say ENODEV from now on.
BUS_API void unplug_evdev(size_t number);

/// What the effects that play add up to. As the kernel does, it erases them when no process has
/// the device open and locked any more.
struct EvdevLevels {
  int right = 0;
  int up = 0;
  int rumble = 0;
  bool at_rest() const { return right == 0 && up == 0 && rumble == 0; }
};
BUS_API EvdevLevels evdev_levels(size_t number);

}  // namespace spidar::test
