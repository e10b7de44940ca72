// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/force_feedback/packets.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <linux/input.h>

#include "spidar/guardian/guardian.h"

namespace spidar::ff {
namespace {

static_assert(sizeof(input_event) == kEventSize && sizeof(ff_effect) == kEffectSize,
              "the kernel's structures have another size on this architecture");

template <typename Bytes, typename Structure>
Bytes as_bytes(const Structure& structure) noexcept {
  Bytes bytes;
  static_assert(sizeof bytes == sizeof structure);
  std::memcpy(bytes.data(), &structure, sizeof structure);
  return bytes;
}

EventBytes encode_event(int code, int32_t value) noexcept {
  input_event event{};
  event.type = EV_FF;
  event.code = static_cast<uint16_t>(code);
  event.value = value;
  return as_bytes<EventBytes>(event);
}

}  // namespace

EffectBytes encode_constant(int16_t number, Direction direction, int level) noexcept {
  ff_effect effect{};
  effect.type = FF_CONSTANT;
  effect.id = number;
  effect.replay.length = kEffect_ms;
  effect.direction = static_cast<uint16_t>(direction);
  effect.u.constant.level = static_cast<int16_t>(std::clamp(level, -kFullLevel, kFullLevel));
  return as_bytes<EffectBytes>(effect);
}

EffectBytes encode_rumble(int16_t number, int strength) noexcept {
  ff_effect effect{};
  effect.type = FF_RUMBLE;
  effect.id = number;
  effect.replay.length = kEffect_ms;
  effect.u.rumble.strong_magnitude = static_cast<uint16_t>(std::clamp(strength, 0, kFullStrength));
  return as_bytes<EffectBytes>(effect);
}

EventBytes encode_play(int16_t number, bool on) noexcept {
  return encode_event(number, on ? 1 : 0);
}

EventBytes encode_gain(int gain) noexcept {
  return encode_event(FF_GAIN, gain);
}

EventBytes encode_autocentre(int strength) noexcept {
  return encode_event(FF_AUTOCENTER, strength);
}

std::optional<Effect> decode_effect(ByteView bytes) noexcept {
  ff_effect effect{};
  if (bytes.size != sizeof effect) return std::nullopt;
  std::memcpy(&effect, bytes.data, sizeof effect);
  Effect result;
  result.number = effect.id;
  result.length_ms = effect.replay.length;
  if (effect.type == FF_RUMBLE) {
    result.rumble = double{1} * effect.u.rumble.strong_magnitude / kFullStrength;
  } else if (effect.type == FF_CONSTANT) {
    // The direction 0 is down; then clockwise: left, up, right.
    const double angle_rad = effect.direction * 2 * M_PI / 0x10000;
    const double level = double{1} * effect.u.constant.level / kFullLevel;
    result.right = -std::sin(angle_rad) * level;
    result.up = -std::cos(angle_rad) * level;
  } else {
    return std::nullopt;
  }
  return result;
}

std::optional<Event> decode_event(ByteView bytes) noexcept {
  input_event event{};
  if (bytes.size != sizeof event) return std::nullopt;
  std::memcpy(&event, bytes.data, sizeof event);
  if (event.type != EV_FF) return std::nullopt;
  return Event{event.code, event.value};
}

}  // namespace spidar::ff
