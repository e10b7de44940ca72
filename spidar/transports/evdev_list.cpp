// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/transports/evdev_list.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <dirent.h>
#include <fcntl.h>
#include <filesystem>
#include <linux/input.h>
#include <memory>
#include <system_error>
#include <unistd.h>

namespace spidar {
namespace {

constexpr const char* kSysfs = "/sys/class/input";

/// The beginning of a file; empty when it cannot be read.
std::string beginning(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return {};
  std::array<char, 256> text{};
  const ssize_t length = ::read(file, text.data(), text.size());
  ::close(file);
  return {text.data(), static_cast<size_t>(std::max<ssize_t>(length, 0))};
}

/// The first line of an attribute; empty when it cannot be read.
std::string attribute(const std::string& path) {
  const std::string text = beginning(path);
  return text.substr(0, text.find('\n'));
}

/// Bits as sysfs prints them: hexadecimal words of the size of a long, the highest first.
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
    const std::string bits = attribute(device + "capabilities/ff");
    EvdevInfo info;
    info.constant = has_bit(bits, FF_CONSTANT);
    if (!info.constant && !has_bit(bits, FF_RUMBLE)) continue;
    info.path = "/dev/input/" + event;
    info.name = attribute(device + "name");
    info.serial = attribute(device + "uniq");
    info.id = attribute(device + "id/vendor") + ":" + attribute(device + "id/product");
    info.accessible = access(info.path.c_str(), R_OK | W_OK) == 0;
    devices.push_back(info);
  }
  std::stable_partition(devices.begin(), devices.end(),
                        [](const EvdevInfo& info) { return info.constant; });
  return devices;
}

std::string evdev_driver(const std::string& path) {
  std::error_code error;
  std::filesystem::path file = std::filesystem::canonical(path, error);
  if (error) file = path;
  // The parent of an input device is the device that the driver is bound to, for example on the HID
  // bus. Its uevent file has a line DRIVER=NAME (dev_uevent() in drivers/base/core.c of the
  // kernel).
  const std::string of_parent = file.filename().string() + "/device/device/uevent";
  const std::string uevent = "\n" + beginning(std::string(kSysfs) + "/" + of_parent);
  constexpr const char* kKey = "\nDRIVER=";
  const size_t key = uevent.find(kKey);
  if (key == std::string::npos) return {};
  const size_t begin = key + std::strlen(kKey);
  return uevent.substr(begin, uevent.find('\n', begin) - begin);
}

}  // namespace spidar
