// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Requests to a force-feedback device of Linux, and their answers.
///
/// Source: linux/input.h and Documentation/input/ff.rst of the kernel. Evdev works through ioctl()
/// calls: a request is the structure of its call, identified by its size, and EvdevTransport makes
/// the call. The functions only convert numbers and bytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/default_limits.h"
#include "spidar/transports/bytes.h"

namespace spidar::ff {

/// The force at full level. Devices do not report their strength; this value is the default of the
/// element's max-force, so that the whole range is used.
constexpr double kFullForce_N = kDefaultForce_N;
constexpr int kFullLevel = 0x7FFF;
constexpr int kFullStrength = 0xFFFF;
constexpr int kFullGain = 0xFFFF;
/// The number in a new effect; the answer contains the number that the device has assigned.
constexpr int16_t kNewEffect = -1;

/// Directions as the kernel counts them (Documentation/input/ff.rst): 0 is down, then clockwise. A
/// force to the right is a negative level to the left, not 0xC000, for two reasons. hid-pidff plays
/// every effect of a wheel base with HID_PIDFF_QUIRK_FIX_WHEEL_DIRECTION to the left, 0x4000,
/// whatever its direction is; and many wheels do not have the field at all. With 0xC000, forces to
/// the right would be reversed there. Drivers that use the direction multiply its sine by the level
/// (ml_combine_effects() in drivers/input/ff-memless.c), so both ways give the same force. SDL, and
/// so most games, uses 0x4000 for steering wheels, too (SDL_SYS_ToDirection() in SDL_syshaptic.c).
enum class Direction : uint16_t { kLeft = 0x4000, kUp = 0x8000 };

/// The capabilities of the device, in plain bytes: the answer to encode_describe().
struct Description {
  uint8_t constant = 0;    ///< FF_CONSTANT: a force with a direction
  uint8_t rumble = 0;      ///< FF_RUMBLE: a strength
  uint8_t gain = 0;        ///< FF_GAIN
  uint8_t autocentre = 0;  ///< FF_AUTOCENTER
  uint8_t effects = 0;     ///< how many effects the device holds at once, at most 255
  uint8_t axes = 0;        ///< number of axes of the position: 0, 1 (a wheel) or 2
  uint8_t buttons = 0;     ///< number of the buttons, at most 32
  /// The driver turns autocentre on when the device is plugged in; other drivers turn it off.
  uint8_t starts_centred = 0;
  uint8_t axes_by_id = 0;  ///< the number of axes follows from the USB ID
  std::array<char, 80> name{};
};

/// The position of the stick and its buttons, in plain bytes: the answer to encode_position().
struct Position {
  static constexpr int kFull = 10'000;
  int16_t right = 0;  ///< −kFull … kFull; 0 without that axis
  int16_t up = 0;
  uint32_t buttons = 0;  ///< the pressed ones; the first button is the lowest bit
};

constexpr size_t kDescribeSize = 1;
constexpr size_t kPositionSize = 2;
constexpr size_t kEventSize = 2 * sizeof(long) + 8;           ///< struct input_event
constexpr size_t kEffectSize = sizeof(void*) == 8 ? 48 : 44;  ///< struct ff_effect

using EventBytes = std::array<uint8_t, kEventSize>;
using EffectBytes = std::array<uint8_t, kEffectSize>;

constexpr std::array<uint8_t, kDescribeSize> kDescribe{};
constexpr std::array<uint8_t, kPositionSize> kPosition{};

/// Encodes FF_CONSTANT for kEffect_ms in a fixed direction; `level` is clamped to ±kFullLevel.
EffectBytes encode_constant(int16_t number, Direction direction, int level) noexcept;
/// Encodes FF_RUMBLE for kEffect_ms; the strong motor's `strength` is clamped to kFullStrength.
EffectBytes encode_rumble(int16_t number, int strength) noexcept;
/// Starts or stops an effect. An effect that is playing starts again from its beginning.
EventBytes encode_play(int16_t number, bool on) noexcept;
EventBytes encode_gain(int gain) noexcept;
EventBytes encode_autocentre(int strength) noexcept;

/// An effect as a device receives it.
struct Effect {
  int16_t number = kNewEffect;
  double right = 0;  ///< fractions of the full level
  double up = 0;
  double rumble = 0;
  int length_ms = 0;  ///< 0: no limit
};
/// Returns nothing unless the effect is FF_CONSTANT or FF_RUMBLE and has kEffectSize bytes.
std::optional<Effect> decode_effect(ByteView bytes) noexcept;

/// An EV_FF event, whose code is the number of an effect, FF_GAIN or FF_AUTOCENTER.
struct Event {
  uint16_t code = 0;
  int32_t value = 0;
};
/// Returns nothing unless the event is EV_FF and has kEventSize bytes.
std::optional<Event> decode_event(ByteView bytes) noexcept;

}  // namespace spidar::ff
