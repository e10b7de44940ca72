// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Finds the USB device that a name means, among those that are plugged in.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "spidar/boards/usb_kinds.h"
#include "spidar/transports/usb_transport.h"

namespace spidar {

/// To be used for every opening, because the address changes when a device is plugged in again.
class UsbSearch {
 public:
  struct Candidate {
    const UsbBoardKind* kind = nullptr;
    UsbDeviceInfo device;
  };
  /// Opens a candidate and returns its rotary switch, −1 without one. Throws DeviceError.
  using Open = std::function<int(const Candidate&)>;

  /// `id`: bus path, serial number, or position of the rotary switch, 0 … 15. If empty, there must
  /// be only one device.
  UsbSearch(UsbFamily family, std::string name, std::string id);

  /// Opens the device that is meant. `close` closes one that was opened and is another. Throws
  /// DeviceError, which lists what there is.
  void open(const Open& open, const std::function<void()>& close) const;

 private:
  std::vector<Candidate> candidates() const;
  void open_matching(const std::vector<Candidate>& found, const Open& open,
                     const std::function<void()>& close) const;

  const UsbFamily family_;
  const std::string name_;
  const std::string id_;
};

}  // namespace spidar
