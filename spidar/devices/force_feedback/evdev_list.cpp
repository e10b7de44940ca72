// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/force_feedback/evdev_list.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <dirent.h>
#include <filesystem>
#include <memory>
#include <system_error>
#include <unistd.h>

#include "spidar/text.h"

namespace spidar {
namespace {

constexpr const char* kSysfs = "/sys/class/input";

/// Tests a bit in the words of sysfs: hexadecimal, of the size of a long, the highest first.
bool has_bit(const std::string& words, unsigned bit) {
  constexpr unsigned kBits = 8 * sizeof(unsigned long);
  std::string left = words;
  for (unsigned word = bit / kBits; word > 0; --word) {
    const size_t space = left.rfind(' ');
    if (space == std::string::npos) return false;
    left.resize(space);
  }
  const size_t space = left.rfind(' ');
  const std::string last = space == std::string::npos ? left : left.substr(space + 1);
  return std::strtoul(last.c_str(), nullptr, 16) >> bit % kBits & 1;
}

std::vector<int> event_numbers() {
  std::vector<int> numbers;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(opendir(kSysfs), closedir);
  if (!folder) return numbers;
  while (const dirent* entry = readdir(folder.get())) {
    const std::string name = entry->d_name;
    if (name.rfind("event", 0) == 0) numbers.push_back(std::atoi(name.c_str() + 5));
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

}  // namespace

std::vector<EvdevInfo> list_force_feedback() {
  std::vector<EvdevInfo> devices;
  for (const int number : event_numbers()) {
    const std::string event = "event" + std::to_string(number);
    const std::string device = std::string(kSysfs) + "/" + event + "/device/";
    const std::string bits = first_line(device + "capabilities/ff");
    EvdevInfo info;
    info.constant = has_bit(bits, FF_CONSTANT);
    if (!info.constant && !has_bit(bits, FF_RUMBLE)) continue;
    info.path = "/dev/input/" + event;
    info.name = first_line(device + "name");
    info.serial = first_line(device + "uniq");
    info.id = first_line(device + "id/vendor") + ":" + first_line(device + "id/product");
    info.place = first_line(device + "phys");
    info.accessible = access(info.path.c_str(), R_OK | W_OK) == 0;
    devices.push_back(info);
  }
  std::stable_partition(devices.begin(), devices.end(),
                        [](const EvdevInfo& info) { return info.constant; });
  return devices;
}

DeviceIdentity evdev_identity(int file) {
  input_id id{};
  call_ioctl(file, EVIOCGID, &id);
  const std::string numbers = formatted("%04x:%04x", id.vendor, id.product);
  std::array<char, 256> name{}, serial{}, place{};  // the first line, as in sysfs
  const auto line = [](const std::array<char, 256>& text) {
    return printable({text.data(), std::strcspn(text.data(), "\n")});
  };
  call_ioctl(file, EVIOCGNAME(name.size() - 1), name.data());
  call_ioctl(file, EVIOCGUNIQ(serial.size() - 1), serial.data());
  call_ioctl(file, EVIOCGPHYS(place.size() - 1), place.data());
  return EvdevInfo{{}, line(name), line(serial), numbers, line(place)}.identity();
}

std::string without_links(const std::string& path) {
  std::error_code error;
  const std::filesystem::path file = std::filesystem::canonical(path, error);
  return error ? path : file.string();
}

std::string evdev_driver(const std::string& path) {
  const std::filesystem::path file = without_links(path);
  // The parent of an input device is the device that the driver is bound to, for example on the HID
  // bus. The parent's uevent file has a line DRIVER=NAME (dev_uevent() in drivers/base/core.c).
  const std::string of_parent = file.filename().string() + "/device/device/uevent";
  const std::string uevent = "\n" + beginning_of(std::string(kSysfs) + "/" + of_parent);
  constexpr const char* kKey = "\nDRIVER=";
  const size_t key = uevent.find(kKey);
  if (key == std::string::npos) return {};
  const size_t begin = key + std::strlen(kKey);
  return uevent.substr(begin, uevent.find('\n', begin) - begin);
}

namespace {

/// Vendor and product of wheels and wheel bases with force feedback, from the kernel's drivers
/// hid-universal-pidff, hid-lg4ff and hid-tmff (drivers/hid/hid-ids.h and hid-tmff.c, Linux 6.15),
/// from SDL 3.2 (initial_wheel_devices in SDL_joystick.c), and from
/// https://github.com/JacKeTUs/linux-steering-wheels (its table, and its issue 24). A vendor is not
/// enough, because most vendors also make joysticks or pedals.
constexpr uint32_t kWheels[] = {
    0x0079'1864,  // DragonRise
    0x044f'b605, 0x044f'b653, 0x044f'b654, 0x044f'b65a, 0x044f'b65d, 0x044f'b65e, 0x044f'b664,
    0x044f'b669, 0x044f'b66d, 0x044f'b66e, 0x044f'b66f, 0x044f'b677, 0x044f'b67f, 0x044f'b691,
    0x044f'b692, 0x044f'b696,  // Thrustmaster
    0x045b'59d7,               // FFBeast
    0x046d'c24f, 0x046d'c260, 0x046d'c261, 0x046d'c262, 0x046d'c266, 0x046d'c267, 0x046d'c268,
    0x046d'c269, 0x046d'c26d, 0x046d'c26e, 0x046d'c272, 0x046d'c293, 0x046d'c294, 0x046d'c295,
    0x046d'c298, 0x046d'c299, 0x046d'c29a, 0x046d'c29b, 0x046d'c29c, 0x046d'ca03,
    0x046d'ca04,               // Logitech
    0x0483'0522, 0x0483'a355,  // Simagic, VRS
    0x0583'a132, 0x0583'a133, 0x0583'a202, 0x0583'b002, 0x0583'b005, 0x0583'b008, 0x0583'b009,
    0x0583'b018,  // Padix
    0x0eb7'0001, 0x0eb7'0004, 0x0eb7'0005, 0x0eb7'0006, 0x0eb7'0007, 0x0eb7'0011, 0x0eb7'0020,
    0x0eb7'0197, 0x0eb7'038e, 0x0eb7'0e03,  // Fanatec
    0x10f5'7077,                            // Turtle Beach VelocityOne Race
    0x11ff'0511, 0x11ff'1112, 0x11ff'1211, 0x11ff'1212, 0x11ff'2141,
    0x11ff'3245,                                                      // Lite Star, PXN
    0x1209'ffb0,                                                      // OpenFFBoard
    0x16d0'0d5a, 0x16d0'0d5f, 0x16d0'0d60, 0x16d0'0d61,               // Simucube
    0x1fc9'804c,                                                      // SimXperience AccuForce Pro
    0x2433'f300, 0x2433'f301, 0x2433'f303, 0x2433'f306,               // Asetek
    0x3416'0301, 0x3416'0302,                                         // Cammus
    0x346e'0000, 0x346e'0002, 0x346e'0004, 0x346e'0005, 0x346e'0006,  // MOZA
    0x346e'0010, 0x346e'0012, 0x346e'0014, 0x346e'0015, 0x346e'0016,
};

/// Joysticks that have neither "stick" in their name nor exactly two axes.
constexpr uint32_t kJoysticks[] = {
    0x045b'58f9,  // FFBeast; "the second joystick axis" in the kernel's hid-universal-pidff.c
    // MOZA AB9 and AB6 FFB Base: https://github.com/bobhelander/EDForceFeedback/pull/36
    0x346e'1000,
    0x346e'1002,
};

bool has_pedals(const EvdevTraits& traits) noexcept {
  if (has(traits.axes, ABS_GAS) || has(traits.axes, ABS_BRAKE)) return true;
  return has(traits.axes, ABS_Z) && has(traits.axes, ABS_RZ) &&
         !strcasestr(traits.name.data(), "stick");
}

}  // namespace

EvdevTraits evdev_traits(int file) {
  EvdevTraits traits;
  input_id id{};
  if (call_ioctl(file, EVIOCGID, &id) >= 0) {
    traits.vendor = id.vendor;
    traits.product = id.product;
  }
  call_ioctl(file, EVIOCGNAME(traits.name.size() - 1), traits.name.data());
  const std::string name = printable(traits.name.data());  // printable() does not lengthen the text
  traits.name = {};
  std::copy(name.begin(), name.end(), traits.name.begin());
  traits.axes = codes<ABS_CNT>(file, EV_ABS);
  traits.keys = codes<KEY_CNT>(file, EV_KEY);
  return traits;
}

int axes_by_id(const EvdevTraits& traits) noexcept {
  const uint32_t id = uint32_t{traits.vendor} << 16 | traits.product;
  const auto is_in = [id](const auto& ids) {
    return std::find(std::begin(ids), std::end(ids), id) != std::end(ids);
  };
  return is_in(kWheels) ? 1 : is_in(kJoysticks) ? 2 : 0;
}

bool is_wheel(const EvdevTraits& traits) noexcept {
  const int known = axes_by_id(traits);
  if (known != 0) return known == 1;
  return strcasestr(traits.name.data(), "wheel") || has(traits.axes, ABS_WHEEL) ||
         has(traits.keys, BTN_GEAR_DOWN) || has(traits.keys, BTN_GEAR_UP) || has_pedals(traits);
}

}  // namespace spidar
