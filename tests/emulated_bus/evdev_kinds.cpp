// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/emulated_bus/evdev_kinds.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <linux/input.h>

namespace spidar::test {

bool is_constant(EvdevKind kind) {
  return kind == EvdevKind::kStick || kind == EvdevKind::kWheel || kind == EvdevKind::kWheelBase ||
         kind == EvdevKind::kPedalBase || kind == EvdevKind::kOneAxis ||
         kind == EvdevKind::kFlightBase;
}

std::vector<unsigned> ff_bits(EvdevKind kind) {
  switch (kind) {
    case EvdevKind::kStick:
      return {FF_CONSTANT, FF_RUMBLE, FF_GAIN, FF_AUTOCENTER};
    case EvdevKind::kWheel:
    case EvdevKind::kWheelBase:
    case EvdevKind::kPedalBase:
      return {FF_CONSTANT, FF_GAIN, FF_AUTOCENTER};
    case EvdevKind::kOneAxis:
      return {FF_CONSTANT, FF_AUTOCENTER};
    case EvdevKind::kFlightBase:
      return {FF_CONSTANT, FF_GAIN};
    case EvdevKind::kPad:
      return {FF_RUMBLE};
    default:
      return {};
  }
}

std::vector<unsigned> abs_bits(EvdevKind kind) {
  if (kind == EvdevKind::kWheel) return {ABS_X, ABS_Y};  // the second is a pedal
  if (kind == EvdevKind::kKeyboard) return {};
  if (kind == EvdevKind::kOneAxis) return {ABS_X};
  if (kind == EvdevKind::kPedalBase || kind == EvdevKind::kFlightBase)
    return {ABS_X, ABS_Y, ABS_Z, ABS_RZ};
  if (kind == EvdevKind::kStick) return {ABS_X, ABS_Y, ABS_RZ, ABS_THROTTLE};  // it can be twisted
  return {ABS_X, ABS_Y};
}

std::vector<unsigned> key_bits(EvdevKind kind) {
  if (kind == EvdevKind::kStick) return {BTN_0, BTN_TRIGGER, BTN_THUMB};
  return {};
}

const char* name_of(EvdevKind kind) {
  switch (kind) {
    case EvdevKind::kStick:
      return "Emulated Stick";
    case EvdevKind::kWheel:
      return "Emulated Racing Wheel";
    case EvdevKind::kPad:
      return "Emulated Pad";
    case EvdevKind::kWheelBase:
      return "MOZA R5 Base";
    case EvdevKind::kPedalBase:
      return "Emulated Base";
    case EvdevKind::kOneAxis:
      return "Emulated Dial";
    case EvdevKind::kFlightBase:
      return "MOZA AB9 FFB Base";
    default:
      return "Emulated Keyboard";
  }
}

UsbId usb_id_of(EvdevKind kind) {
  if (kind == EvdevKind::kWheelBase) return {0x346e, 0x0004};
  if (kind == EvdevKind::kFlightBase) return {0x346e, 0x1000};
  return {0x1209, static_cast<uint16_t>(kind)};
}

const char* driver_of(EvdevKind kind) {
  switch (kind) {
    case EvdevKind::kStick:
      return "iforce";
    case EvdevKind::kWheel:
      return "logitech";
    case EvdevKind::kPad:
      return "xpad";
    case EvdevKind::kWheelBase:
      return "hid-universal-pidff";
    default:
      return "hid-generic";
  }
}

std::string sysfs_bits(const std::vector<unsigned>& bits) {
  unsigned long words[2] = {};
  for (const unsigned bit : bits) words[bit / 64] |= 1UL << bit % 64;
  std::array<char, 40> text{};
  if (words[1] != 0)
    std::snprintf(text.data(), text.size(), "%lx %lx\n", words[1], words[0]);
  else
    std::snprintf(text.data(), text.size(), "%lx\n", words[0]);
  return text.data();
}

int put_bits(const std::vector<unsigned>& bits, void* argument, size_t size) {
  auto* bytes = static_cast<uint8_t*>(argument);
  std::fill_n(bytes, size, uint8_t{0});
  for (const unsigned bit : bits)
    if (bit / 8 < size) bytes[bit / 8] = static_cast<uint8_t>(bytes[bit / 8] | 1 << bit % 8);
  return static_cast<int>(size);
}

}  // namespace spidar::test
