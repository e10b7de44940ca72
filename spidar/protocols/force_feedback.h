// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Requests to a force-feedback device of Linux, and its answers.
///
/// Source: linux/input.h and Documentation/input/ff.rst of the kernel. Evdev is called, not written
/// to: a request is the structure of its call, told by its size, and EvdevTransport makes the call.
/// Pure: numbers in, bytes out.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/api.h"
#include "spidar/protocols/bytes.h"

namespace spidar::ff {

/// The force that full level stands for. Devices do not say how strong they are; this is the
/// default of the element's max-force, so that the whole range is used.
constexpr double kFullForce_N = 3.0;
constexpr int kFullLevel = 0x7FFF;
constexpr int kFullStrength = 0xFFFF;
constexpr int kFullGain = 0xFFFF;
/// A new effect is uploaded with this number, and answered with its own.
constexpr int16_t kNewEffect = -1;

enum class Direction : uint16_t { kRight = 0xC000, kUp = 0x8000 };

/// What the device has: the answer to encode_describe(). Plain bytes.
struct Description {
  uint8_t constant = 0;    ///< FF_CONSTANT: a force with a direction
  uint8_t rumble = 0;      ///< FF_RUMBLE: a strength
  uint8_t gain = 0;        ///< FF_GAIN
  uint8_t autocentre = 0;  ///< FF_AUTOCENTER
  uint8_t effects = 0;     ///< that there is room for, 255 at most
  uint8_t axes = 0;        ///< of its position: 0, 1 (a wheel) or 2
  std::array<char, 80> name{};
};

/// Where the stick is: the answer to encode_position(). Plain bytes.
struct Position {
  static constexpr int kFull = 10'000;
  int16_t right = 0;  ///< −kFull … kFull; 0 without that axis
  int16_t up = 0;
};

constexpr size_t kDescribeSize = 1;
constexpr size_t kPositionSize = 2;
constexpr size_t kEventSize = 2 * sizeof(long) + 8;           ///< struct input_event
constexpr size_t kEffectSize = sizeof(void*) == 8 ? 48 : 44;  ///< struct ff_effect
constexpr size_t kNumberSize = 2;  ///< the answer to an effect: its number

using EventBytes = std::array<uint8_t, kEventSize>;
using EffectBytes = std::array<uint8_t, kEffectSize>;

constexpr std::array<uint8_t, kDescribeSize> kDescribe{};
constexpr std::array<uint8_t, kPositionSize> kPosition{};

/// FF_CONSTANT without end in a fixed direction; `level` −kFullLevel … kFullLevel is clamped.
SPIDAR_API EffectBytes encode_constant(int16_t number, Direction direction, int level) noexcept;
/// FF_RUMBLE without end; `strength` 0 … kFullStrength of the strong motor is clamped.
SPIDAR_API EffectBytes encode_rumble(int16_t number, int strength) noexcept;
/// Begins or ends an effect.
SPIDAR_API EventBytes encode_play(int16_t number, bool on) noexcept;
SPIDAR_API EventBytes encode_gain(int gain) noexcept;
SPIDAR_API EventBytes encode_autocentre(int strength) noexcept;

/// An effect as a device takes it.
struct Effect {
  int16_t number = kNewEffect;
  double right = 0;  ///< shares of the full level
  double up = 0;
  double rumble = 0;
};
/// Nothing when it is neither FF_CONSTANT nor FF_RUMBLE, or not of kEffectSize.
SPIDAR_API std::optional<Effect> decode_effect(ByteView bytes) noexcept;

/// Of EV_FF: the number of an effect, or FF_GAIN or FF_AUTOCENTER.
struct Event {
  uint16_t code = 0;
  int32_t value = 0;
};
/// Nothing when it is not of EV_FF, or not of kEventSize.
SPIDAR_API std::optional<Event> decode_event(ByteView bytes) noexcept;

}  // namespace spidar::ff
