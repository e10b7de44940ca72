// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Lists force-feedback devices, and distinguishes steering wheels from joysticks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <linux/input.h>
#include <string>
#include <sys/ioctl.h>
#include <vector>

#include "spidar/realtime/uninterrupted.h"
#include "spidar/transports/device_identity.h"

namespace spidar {

template <size_t Bits>
using BitSet = std::array<uint8_t, Bits / 8 + 1>;

template <size_t N>
bool has(const std::array<uint8_t, N>& bits, unsigned bit) noexcept {
  return bits[bit / 8] >> bit % 8 & 1;
}

/// The codes of an event type that the device supports; none if the device does not report them.
template <size_t Bits>
BitSet<Bits> codes(int file, unsigned type) noexcept {
  BitSet<Bits> bits{};
  if (call_ioctl(file, EVIOCGBIT(type, sizeof bits), bits.data()) < 0) bits.fill(0);
  return bits;
}

struct EvdevInfo {
  std::string path;         ///< "/dev/input/event5"; every text here is printable()
  std::string name;         ///< from the driver; may be empty
  std::string serial;       ///< empty if the device has none
  std::string id;           ///< vendor and product: "046d:c24f"
  std::string place;        ///< "usb-0000:00:14.0-2/input0"; may be empty
  bool constant = false;    ///< supports directional force; otherwise the device only rumbles
  bool accessible = false;  ///< this process may open the device

  DeviceIdentity identity() const { return {name + " (" + id + ")", serial, place}; }
};

/// Returns input devices with FF_CONSTANT, then those with only FF_RUMBLE, sorted by number. Reads
/// the kernel's description in /sys/class/input, and opens no device.
std::vector<EvdevInfo> list_force_feedback();

DeviceIdentity evdev_identity(int file);

/// Returns `path` with all links resolved; unchanged if there is no such file.
std::string without_links(const std::string& path);

/// Returns the name of the kernel driver of an input device ("/dev/input/event5", or a link to
/// that): "logitech", "iforce", "hid-generic", …; empty when sysfs does not name one.
std::string evdev_driver(const std::string& path);

/// What the kernel reports about an input device.
struct EvdevTraits {
  uint16_t vendor = 0;
  uint16_t product = 0;
  std::array<char, 80> name{};  ///< printable()
  BitSet<ABS_CNT> axes{};
  BitSet<KEY_CNT> keys{};
};

EvdevTraits evdev_traits(int file);

/// Returns how many axes have a force according to the USB ID: 1 for a wheel, 2 for a joystick; 0
/// when the ID does not tell.
int axes_by_id(const EvdevTraits& traits) noexcept;

/// Returns whether the second axis of the device is a pedal or a lever instead of the other axis of
/// a stick; Linux does not report that. On a wheel that is taken for a joystick, vertical forces
/// would turn the wheel; a joystick that is taken for a wheel only lacks these forces. When in
/// doubt, a device therefore counts as a wheel. The signs of a wheel are its USB ID, its name, an
/// axis or a button that only wheels have, and pedals. A joystick that can be twisted has ABS_RZ,
/// too, but joysticks seldom have ABS_Z.
bool is_wheel(const EvdevTraits& traits) noexcept;

}  // namespace spidar
