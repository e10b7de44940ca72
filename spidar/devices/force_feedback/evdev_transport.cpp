// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/force_feedback/evdev_transport.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <linux/input.h>
#include <string_view>
#include <unistd.h>
#include <utility>

#include "spidar/device.h"

namespace spidar {
namespace {

/// The drivers by which hid-pidff drives USB PID devices. Only hid-pidff sets autocentre to its
/// full strength when the device is plugged in (pidff_check_autocenter() in
/// drivers/hid/usbhid/hid-pidff.c, unchanged up to Linux 6.15). hid-lg4ff and iforce set autocentre
/// to zero, and the other drivers do not change it. Linux provides no way to read it.
constexpr std::array<std::string_view, 2> kCentringDrivers{"hid-generic", "hid-universal-pidff"};

constexpr size_t kMaxButtons = 32;  ///< the capacity of ff::Position::buttons

LinkFault fault_of_input(int error) noexcept {
  switch (error) {
    case ENODEV:
    case ENXIO:
    case EBADF:
      return LinkFault::kGone;
    case ETIMEDOUT:
      return LinkFault::kTimeout;
    case EACCES:
    case EINVAL:
    case ENOMEM:
    case ENOSPC:
    case ENOSYS:
      return LinkFault::kRefused;
    default:
      return LinkFault::kBusError;
  }
}

/// Reads the position on an axis, −kFull … kFull. Returns false when the device is gone.
bool position_on(int file, int axis, int16_t& position) noexcept {
  input_absinfo info{};
  if (call_ioctl(file, EVIOCGABS(static_cast<unsigned>(axis)), &info) < 0) return false;
  const double range = double{1} * info.maximum - info.minimum;
  const double fraction =
      range > 0 ? (double{2} * info.value - info.maximum - info.minimum) / range : 0;
  position =
      static_cast<int16_t>(std::lround(ff::Position::kFull * std::clamp(fraction, -1.0, 1.0)));
  return true;
}

template <typename Structure>
size_t copy_to(const Structure& structure, MutableBytes reply) noexcept {
  const size_t length = std::min(sizeof structure, reply.size);
  std::memcpy(reply.data, &structure, length);
  return length;
}

}  // namespace

EvdevTransport::EvdevTransport(std::string name, std::string path, int axes)
    : name_(std::move(name)), path_(std::move(path)), axes_(axes) {}

EvdevTransport::~EvdevTransport() {
  close();
}

void EvdevTransport::fail(const std::string& path, const std::string& what,
                          SourceLocation location) {
  const int error = errno;
  close();
  std::string advice;
  if (error == EACCES) {
    advice = "; install the udev rule 70-spidar.rules and plug the device in again";
  }
  if (error == ENOENT || error == ENXIO || error == ENODEV) {
    advice = "; spidarctl list names the devices that are plugged in";
  }
  if (error == ENOTTY) advice = "; it is no input device, write ff:/dev/input/eventN";
  if (error == EWOULDBLOCK) advice = "; another program uses it, or another element of this one";
  throw DeviceError(name_ + ": " + path + " " + what + ": " + std::strerror(error) + advice,
                    error_code_of(error), location);
}

/// Returns the path of the device to open.
std::string EvdevTransport::find() {
  if (!first_.known() && !path_.empty()) return path_;
  const std::vector<EvdevInfo> devices = list_force_feedback();
  for (const EvdevInfo& device : devices) {
    if (first_.is(device.identity())) return device.path;
  }
  for (const EvdevInfo& device : devices) {
    if (!path_.empty() && device.path != without_links(path_)) continue;
    if (first_.known()) throw first_.other(name_, device.identity());
    return device.path;
  }
  throw DeviceError(
      name_ + (first_.known() ? ": " + first_.text() + " is not plugged in"
                              : ": no joystick, wheel or gamepad with force feedback is plugged "
                                "in, or the kernel has no driver for it"),
      DeviceErrorCode::kAbsent);
}

void EvdevTransport::open() {
  close();
  const std::string path = find();
  file_ = uninterrupted([&] { return ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC); });
  if (file_ < 0) fail(path, "cannot be opened");
  int version = 0;
  if (call_ioctl(file_, EVIOCGVERSION, &version) < 0) fail(path, "cannot be used");
  if (!lock_device(file_)) fail(path, "cannot be locked");
  try {
    // Check the open file: since the listing, its number may have passed to another device.
    first_.require(name_, evdev_identity(file_));
  } catch (...) {
    close();
    throw;
  }
  const std::string driver = evdev_driver(path);
  starts_centred_ =
      std::find(kCentringDrivers.begin(), kCentringDrivers.end(), driver) != kCentringDrivers.end();
  const EvdevTraits traits = evdev_traits(file_);
  device_name_ = traits.name;
  find_buttons(traits);
  find_axes(path, traits);
}

/// Orders the buttons as the kernel's joystick driver does (joydev_connect() in
/// drivers/input/joydev.c), because programs number them that way: first those of joysticks and
/// gamepads, then all others.
void EvdevTransport::find_buttons(const EvdevTraits& traits) {
  buttons_.clear();
  const auto add = [&](unsigned begin, unsigned end) {
    for (unsigned code = begin; code < end && buttons_.size() < kMaxButtons; ++code) {
      if (has(traits.keys, code)) buttons_.push_back(static_cast<uint16_t>(code));
    }
  };
  add(BTN_JOYSTICK, KEY_CNT);
  add(BTN_MISC, BTN_JOYSTICK);
}

void EvdevTransport::find_axes(const std::string& path, const EvdevTraits& traits) {
  right_axis_ = has(traits.axes, ABS_X) ? ABS_X : has(traits.axes, ABS_WHEEL) ? ABS_WHEEL : -1;
  axes_by_id_ = axes_ == 0 && axes_by_id(traits) != 0;
  const bool two = axes_ == 0 ? !is_wheel(traits) : axes_ == 2;
  up_axis_ = has(traits.axes, ABS_Y) && two ? ABS_Y : -1;
  if (axes_ != 2 || (right_axis_ >= 0 && up_axis_ >= 0)) return;
  close();
  throw DeviceError(name_ + ": \"" + traits.name.data() +
                        "\" does not have two axes (ABS_X and ABS_Y); write ff:" + path + ",axes=1",
                    DeviceErrorCode::kSettings);
}

ff::Description EvdevTransport::describe() const noexcept {
  ff::Description description;
  const auto bits = codes<FF_CNT>(file_, EV_FF);
  description.constant = has(bits, FF_CONSTANT);
  description.rumble = has(bits, FF_RUMBLE);
  description.gain = has(bits, FF_GAIN);
  description.autocentre = has(bits, FF_AUTOCENTER);
  description.starts_centred = starts_centred_;
  description.axes_by_id = axes_by_id_;
  int effects = 0;
  call_ioctl(file_, EVIOCGEFFECTS, &effects);
  description.effects = static_cast<uint8_t>(std::clamp(effects, 0, 255));
  description.axes = static_cast<uint8_t>((right_axis_ >= 0) + (up_axis_ >= 0));
  description.buttons = static_cast<uint8_t>(buttons_.size());
  description.name = device_name_;
  return description;
}

bool EvdevTransport::read_position(ff::Position& position) const noexcept {
  int effects = 0;
  // A device without axes is queried, too, because the answer shows that it is still connected.
  if (call_ioctl(file_, EVIOCGEFFECTS, &effects) < 0) return false;
  if (right_axis_ >= 0 && !position_on(file_, right_axis_, position.right)) return false;
  if (up_axis_ >= 0 && !position_on(file_, up_axis_, position.up)) return false;
  position.up = static_cast<int16_t>(-position.up);  // y of a stick points down
  return read_buttons(position);
}

bool EvdevTransport::read_buttons(ff::Position& position) const noexcept {
  BitSet<KEY_CNT> pressed{};
  if (buttons_.empty()) return true;
  if (call_ioctl(file_, EVIOCGKEY(sizeof pressed), pressed.data()) < 0) return false;
  for (size_t i = 0; i < buttons_.size(); ++i) {
    if (has(pressed, buttons_[i])) position.buttons |= uint32_t{1} << i;
  }
  return true;
}

LinkFault EvdevTransport::send(ByteView packet, MutableBytes reply, size_t& received) noexcept {
  if (packet.size == ff::kDescribeSize) {
    received = copy_to(describe(), reply);
    return LinkFault::kNone;
  }
  if (packet.size == ff::kPositionSize) {
    ff::Position position;
    if (!read_position(position)) return fault_of_input(errno);
    received = copy_to(position, reply);
    return LinkFault::kNone;
  }
  if (packet.size == ff::kEffectSize) {
    ff_effect effect{};
    std::memcpy(&effect, packet.data, sizeof effect);
    if (call_ioctl(file_, EVIOCSFF, &effect) < 0) return fault_of_input(errno);
    received = copy_to(effect.id, reply);
    return LinkFault::kNone;
  }
  const ssize_t written = uninterrupted([&] { return ::write(file_, packet.data, packet.size); });
  if (written < 0) return fault_of_input(errno);
  return written == static_cast<ssize_t>(packet.size) ? LinkFault::kNone : LinkFault::kShort;
}

Transfer EvdevTransport::transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                                  int64_t) noexcept {
  if (file_ < 0) return {LinkFault::kGone, 0};
  size_t received = 0;
  for (const ByteView packet : packets) {
    errno = 0;
    const LinkFault fault = send(packet, reply, received);
    if (fault != LinkFault::kNone) return {fault, 0, errno};
  }
  return {received < reply.size ? LinkFault::kShort : LinkFault::kNone, received};
}

std::optional<LastWill> EvdevTransport::last_will() const {
  LastWill will;
  will.wire = LastWill::Wire::kInput;
  will.file = file_;
  return will;
}

void EvdevTransport::close() noexcept {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

}  // namespace spidar
