// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/kernel/uinput_device.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <linux/uinput.h>
#include <poll.h>
#include <stdexcept>
#include <sys/ioctl.h>
#include <unistd.h>
#include <vector>

#include "spidar/devices/force_feedback/packets.h"
#include "spidar/session/board_list.h"
#include "tests/support/felt_player.h"

namespace spidar::test {
namespace {

void check(int result, const char* what) {
  if (result < 0) throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

std::vector<int> force_feedback_of(UinputKind kind) {
  switch (kind) {
    case UinputKind::kStick:
      return {FF_CONSTANT, FF_GAIN, FF_AUTOCENTER};
    case UinputKind::kWheel:
      return {FF_CONSTANT, FF_AUTOCENTER};
    case UinputKind::kPad:
      break;
  }
  return {FF_RUMBLE};
}

int rounded(double fraction, int full) {
  return static_cast<int>(std::lround(fraction * full));
}

}  // namespace

UinputDevice::UinputDevice(UinputKind kind, const std::string& name) : kind_(kind) {
  file_ = open("/dev/uinput", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  check(file_, "/dev/uinput");
  for (const int type : {EV_ABS, EV_KEY, EV_FF}) check(ioctl(file_, UI_SET_EVBIT, type), "type");
  check(ioctl(file_, UI_SET_KEYBIT, BTN_TRIGGER), "button");
  std::vector<int> axes{ABS_X};
  if (kind != UinputKind::kWheel) axes.push_back(ABS_Y);
  for (const int axis : axes) {
    uinput_abs_setup range{};
    range.code = static_cast<uint16_t>(axis);
    range.absinfo.minimum = -1000;
    range.absinfo.maximum = 1000;
    check(ioctl(file_, UI_SET_ABSBIT, axis), "axis");
    check(ioctl(file_, UI_ABS_SETUP, &range), "range");
  }
  for (const int bit : force_feedback_of(kind)) check(ioctl(file_, UI_SET_FFBIT, bit), "effect");
  uinput_setup setup{};
  setup.id.bustype = BUS_USB;
  setup.id.vendor = 0x1209;
  setup.ff_effects_max = static_cast<uint32_t>(effect_.size());
  name.copy(setup.name, sizeof setup.name - 1);
  check(ioctl(file_, UI_DEV_SETUP, &setup), "setup");
  // Where it is plugged in, each time: what has neither a place nor a serial number never comes
  // back as itself.
  const std::string place = "usb-" + name + "/input0";
  check(ioctl(file_, UI_SET_PHYS, place.c_str()), "place");
  check(ioctl(file_, UI_DEV_CREATE), "create");
  thread_ = std::thread([this] { run(); });
}

UinputDevice::~UinputDevice() {
  ioctl(file_, UI_DEV_DESTROY);
  stop_ = true;
  thread_.join();
  close(file_);
}

void UinputDevice::move(int x, int y) {
  std::array<input_event, 3> events{};
  events[0].type = events[1].type = EV_ABS;
  events[0].code = ABS_X;
  events[0].value = x;
  events[1].code = ABS_Y;
  events[1].value = y;
  events[2].type = EV_SYN;
  check(static_cast<int>(write(file_, events.data(), sizeof events)), "move");
}

void UinputDevice::run() {
  while (!stop_) {
    pollfd ready{file_, POLLIN, 0};
    poll(&ready, 1, 10);
    input_event event{};
    while (read(file_, &event, sizeof event) == sizeof event) {
      const auto value = static_cast<uint32_t>(event.value);
      if (event.type == EV_UINPUT && event.code == UI_FF_UPLOAD) {
        uploading = true;
        take_upload(value);
        uploading = false;
      }
      if (event.type == EV_UINPUT && event.code == UI_FF_ERASE) take_erase(value);
      if (event.type != EV_FF) continue;
      if (event.code == FF_GAIN) gain = event.value;
      if (event.code == FF_AUTOCENTER) autocentre = event.value;
      if (event.code < effect_.size()) effect_[event.code].plays = event.value > 0;
    }
  }
}

void UinputDevice::take_upload(uint32_t request) {
  uinput_ff_upload upload{};
  upload.request_id = request;
  if (ioctl(file_, UI_BEGIN_FF_UPLOAD, &upload) < 0) return;
  // Like hid-pidff for wheel bases with HID_PIDFF_QUIRK_FIX_WHEEL_DIRECTION.
  if (kind_ == UinputKind::kWheel)
    upload.effect.direction = static_cast<uint16_t>(ff::Direction::kLeft);
  if (upload_ms > 0) usleep(static_cast<unsigned>(1000 * upload_ms));
  const auto effect =
      ff::decode_effect({reinterpret_cast<const uint8_t*>(&upload.effect), sizeof upload.effect});
  upload.retval = effect ? 0 : -EINVAL;
  if (upload.retval == 0) {
    Effect& kept = effect_[static_cast<size_t>(effect->number)];
    const int right = rounded(effect->right, ff::kFullLevel);
    const int up = rounded(effect->up, ff::kFullLevel);
    const int rumble = rounded(effect->rumble, ff::kFullStrength);
    if (kept.used && kept.right == right && kept.up == up && kept.rumble == rumble) ++unchanged;
    kept.right = right;
    kept.up = up;
    kept.rumble = rumble;
    kept.used = true;
    ++uploads;
  }
  ioctl(file_, UI_END_FF_UPLOAD, &upload);
}

void UinputDevice::take_erase(uint32_t request) {
  uinput_ff_erase erase{};
  erase.request_id = request;
  if (ioctl(file_, UI_BEGIN_FF_ERASE, &erase) < 0) return;
  Effect& effect = effect_[erase.effect_id];
  effect.used = effect.plays = false;
  effect.right = effect.up = effect.rumble = 0;
  erase.retval = 0;
  ioctl(file_, UI_END_FF_ERASE, &erase);
}

int UinputDevice::sum(std::atomic<int> Effect::*part) const {
  int all = 0;
  for (const Effect& effect : effect_)
    if (effect.plays) all += effect.*part;
  return all;
}

int UinputDevice::right() const {
  return sum(&Effect::right);
}
int UinputDevice::up() const {
  return sum(&Effect::up);
}
int UinputDevice::rumble() const {
  return sum(&Effect::rumble);
}

bool UinputDevice::has_effects() const {
  for (const Effect& effect : effect_)
    if (effect.used) return true;
  return false;
}

std::string listed(const std::string& name) {
  std::string device;
  wait_for([&] {
    for (const DeviceInfo& board : list_boards())
      if (board.name == name) device = board.device;
    return !device.empty();
  });
  return device;
}

}  // namespace spidar::test
