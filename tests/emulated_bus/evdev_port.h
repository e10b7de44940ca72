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
  /// A wheel base that only its USB ID gives away. Like hid-pidff for these, it plays every effect
  /// in the direction 0x4000.
  kWheelBase,
  kPedalBase,  ///< a wheel that only its pedals give away
  kOneAxis,    ///< FF_CONSTANT without gain, and only ABS_X
  /// A joystick that only its USB ID tells from a wheel, and whose driver has no autocentre.
  kFlightBase,
};

/// An input device, as /dev/input/eventN with its number. Any process may change any member at any
/// time.
struct EvdevPort {
  struct Effect {
    std::atomic<bool> used{false};
    std::atomic<bool> plays{false};
    std::atomic<int> length_ms{0};     ///< 0: no limit
    std::atomic<int64_t> began_ns{0};  ///< when it was last started
    std::atomic<int> right{0};         ///< level
    std::atomic<int> up{0};            ///< level
    std::atomic<int> rumble{0};        ///< strength
  };

  std::atomic<EvdevKind> kind{EvdevKind::kNone};
  std::atomic<uint64_t> inode{0};  ///< of its file; a new one each time it is plugged in
  std::array<char, 32> serial{};
  std::array<char, 32> place{};  ///< where it is plugged in
  std::array<char, 64> name{};
  /// Position of the stick, −1000 … 1000: to the right, and towards the user, like ABS_X and ABS_Y.
  std::array<std::atomic<int>, 2> axis{};
  std::atomic<int> axis_end{0};      ///< largest value that the axes announce; 1000 when plugged in
  std::atomic<uint32_t> pressed{0};  ///< buttons: bits in the order of key_bits()
  std::array<Effect, 4> effect{};
  /// Effects end after their length, as in the kernel. Off when plugged in, because on a busy
  /// machine a test may not start them again in time.
  std::atomic<bool> expires{false};
  std::atomic<int> gain{0};
  std::atomic<int> autocentre{0};
  std::atomic<uint64_t> settings{0};  ///< how often gain or autocentre was set

  std::atomic<uint64_t> uploads{0};
  std::atomic<uint64_t> unchanged{0};  ///< uploads that did not change an effect
  std::atomic<uint64_t> plays{0};
  std::atomic<int64_t> shortest_ns{0};  ///< least time between two uploads since it was set to 0

  // What the driver does wrong. Errors are values of errno; 0: none.
  /// Time that an upload takes. A smaller value ends one that is under way.
  std::atomic<int> upload_ms{0};
  std::atomic<int> upload_error{0};        ///< of uploads
  std::atomic<int> failing{-1};            ///< how many of the next uploads fail with it; −1: all
  std::atomic<bool> hangs{false};          ///< uploads do not return until this is false
  std::atomic<int> hanging{0};             ///< uploads that do not return
  std::atomic<int> query_error{0};         ///< of every question for the position
  std::atomic<int> event_error{0};         ///< of every event: play, gain, autocentre
  std::atomic<int> setting_error{0};       ///< of gain and autocentre
  std::atomic<bool> cuts_events{false};    ///< accepts only half of every event
  std::atomic<bool> refuses_stops{false};  ///< the end of an effect is an error
  /// How often the gain was raised to its full value while an effect played.
  std::atomic<int> gain_with_force{0};
  std::atomic<bool> signals{false};  ///< a signal interrupts every other call
  /// The stick centres itself, whatever autocentre is.
  std::atomic<bool> keeps_spring{false};

 private:
  friend class EvdevDriver;
  std::atomic<int64_t> last_upload_ns{0};
  std::atomic<bool> interrupted{false};  ///< the last call was
};

constexpr size_t kEvdevPorts = 6;

/// What tells an emulated device from others of its kind.
struct EvdevIdentity {
  const char* serial = "";
  const char* place = nullptr;  ///< null: a place for each number
  const char* name = nullptr;   ///< null: that of its kind
};

/// Lists the device so that it can be opened, with fresh effects and counters. Sysfs names `driver`
/// as its kernel driver, by default the one of driver_of(); the driver determines `autocentre`.
BUS_API EvdevPort& plug_evdev(size_t number, EvdevKind kind, const char* driver = nullptr,
                              const EvdevIdentity& identity = {});

/// From now on its open files return ENODEV.
BUS_API void unplug_evdev(size_t number);

/// Sum of the playing effects. Like the kernel, it erases them when no process has the device open
/// and locked any more.
struct EvdevLevels {
  int right = 0;
  int up = 0;
  int rumble = 0;
  bool at_rest() const { return right == 0 && up == 0 && rumble == 0; }
};
BUS_API EvdevLevels evdev_levels(size_t number);

}  // namespace spidar::test
