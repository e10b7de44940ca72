// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// An emulated board that a real kernel takes for a device on its USB.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "spidar/devices/device_registry.h"
#include "spidar/link/emulated_transport.h"
#include "tests/kernel/usbip_packets.h"

namespace spidar::test {

/// A board behind the kernel's vhci-hcd, which gets its packets through a socket.
class UsbipBoard {
 public:
  /// Initially not plugged in.
  UsbipBoard(std::shared_ptr<emulated::Motors> motors, std::string serial,
             const std::string& board = "sh4");
  ~UsbipBoard();
  UsbipBoard(const UsbipBoard&) = delete;
  UsbipBoard& operator=(const UsbipBoard&) = delete;

  /// Plugs it into the first port of the virtual host controller. Returns when the kernel has
  /// accepted it, before it has read the descriptors. Throws std::system_error.
  void plug();

  /// Pulls it out at once; nothing when it is not plugged in.
  void unplug();

  /// Pulls it out the next time the host waits for a reply, which never comes.
  void unplug_in_transfer() { unplug_in_transfer_ = true; }

  /// Requests that were waiting for a reply when the board was last pulled out.
  size_t abandoned() const { return abandoned_; }

 private:
  void serve(int socket);
  bool take(const UsbipRequest& request, const std::vector<uint8_t>& data);
  bool control(const UsbipRequest& request);
  bool unlink(const UsbipRequest& request);
  bool answer();
  bool reply(UsbipCommand command, uint32_t sequence, int status, size_t length = 0);
  bool reply_with(const UsbipRequest& request, const std::string& data);
  std::string descriptor(uint8_t type, uint8_t index) const;

  const std::shared_ptr<emulated::Motors> motors_;
  const std::string serial_;
  const DeviceKind& kind_;
  std::thread thread_;
  std::atomic<bool> unplug_in_transfer_{false};
  std::atomic<size_t> abandoned_{0};
  int socket_ = -1;
  // Of the thread.
  emulated::Memory memory_;
  emulated::Board* board_ = nullptr;
  std::deque<UsbipRequest> waiting_;  // IN, for the board to say something
};

}  // namespace spidar::test
