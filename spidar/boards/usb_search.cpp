// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/usb_search.h"

#include <algorithm>
#include <utility>

#include "spidar/device_error.h"
#include "spidar/transports/usb_bus.h"

namespace spidar {
namespace {

/// Position of the rotary switch in `id`; −1 when it contains none.
int rotary_of(const std::string& id) {
  const bool digits =
      !id.empty() && id.size() <= 2 &&
      std::all_of(id.begin(), id.end(), [](char c) { return c >= '0' && c <= '9'; });
  const int number = digits ? std::stoi(id) : -1;
  return number <= 15 ? number : -1;
}

}  // namespace

UsbSearch::UsbSearch(UsbFamily family, std::string name, std::string id)
    : family_(family), name_(std::move(name)), id_(std::move(id)) {}

/// The devices with the path or serial number in the id; without one, all of them.
std::vector<UsbSearch::Candidate> UsbSearch::candidates() const {
  std::vector<Candidate> all, named;
  for (const UsbBoardKind& kind : usb_kinds()) {
    if (kind.family != family_) continue;
    for (UsbDeviceInfo& device : list_usb_devices(kind.vendor, kind.product)) {
      const bool meant = !id_.empty() && (device.path == id_ || device.serial == id_);
      (meant ? named : all).push_back({&kind, std::move(device)});
    }
  }
  return named.empty() ? all : named;
}

void UsbSearch::open(const Open& open, const std::function<void()>& close) const {
  const std::vector<Candidate> found = candidates();
  if (found.empty()) {
    std::string names;
    for (const UsbBoardKind& kind : usb_kinds())
      if (kind.family == family_)
        names += (names.empty() ? "no " : " or ") + std::string(kind.name) + " (" + kind.id() + ")";
    throw DeviceError(name_ + ": " + names + " is plugged in");
  }
  const UsbDeviceInfo& first = found.front().device;
  const bool by_name = !id_.empty() && (first.path == id_ || first.serial == id_);
  if (found.size() == 1 && (by_name || id_.empty()))
    open(found.front());
  else
    open_matching(found, open, close);
}

/// Asks each candidate and keeps the one that reports the wanted rotary switch. Without an id,
/// keeps any that reports the right kind of device.
void UsbSearch::open_matching(const std::vector<Candidate>& found, const Open& open,
                              const std::function<void()>& close) const {
  const int wanted = rotary_of(id_);
  const bool ask = family_ == UsbFamily::kMouse || wanted >= 0;
  std::string listed, trouble;
  for (const Candidate& candidate : found) {
    listed += std::string(" ") + device_of(family_) + ":" + candidate.device.path;
    if (!ask) continue;
    try {
      const int rotary = open(candidate);
      if (rotary == wanted) return;
      listed += " (rotary switch " + std::to_string(rotary) + ")";
      close();
    } catch (const DeviceError& error) {
      trouble += std::string("; ") + error.what();
    }
  }
  const std::string what =
      id_.empty()
          ? "there are several boards, name one of"
          : "no board has the bus path, serial number or rotary switch " + id_ + "; there are";
  throw DeviceError(name_ + ": " + what + listed + trouble);
}

}  // namespace spidar
