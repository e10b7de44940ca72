// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Tells steering wheels from joysticks.
#pragma once

#include <array>
#include <cstdint>
#include <linux/input.h>

#include "spidar/transports/evdev_calls.h"

namespace spidar {

/// What the kernel tells about an input device.
struct EvdevTraits {
  uint16_t vendor = 0;
  uint16_t product = 0;
  std::array<char, 80> name{};
  BitSet<ABS_CNT> axes{};
  BitSet<KEY_CNT> keys{};
};

EvdevTraits evdev_traits(int file) noexcept;

/// True when the second axis of the device is a pedal or a lever, not the other direction of a
/// stick. Linux does not say so. On a wheel that is taken for a joystick, forces up and down turn
/// the wheel; a joystick that is taken for a wheel only lacks them. So this is true in cases of
/// doubt: a wheel is known by its USB ID, its name, an axis or a button that only wheels have, or
/// by pedals. Joysticks have ABS_RZ, too, when they can be twisted, but seldom ABS_Z.
bool is_wheel(const EvdevTraits& traits) noexcept;

}  // namespace spidar
