// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "spidar/transports/transport.h"

struct libusb_context;
struct libusb_device_handle;
struct libusb_transfer;

namespace spidar {

/// A device in the list of the bus, not opened.
struct UsbDeviceInfo {
  uint16_t vendor = 0;
  uint16_t product = 0;
  int bus = 0;
  int address = 0;          ///< changes each time the device is plugged in
  std::string path;         ///< the port: "1-2.3"
  std::string serial;       ///< printable(); empty if the device has none
  bool accessible = false;  ///< this process may write to the device

  std::string device_file() const;
};

using UsbContext = std::unique_ptr<libusb_context, void (*)(libusb_context*)>;

/// A new context scans the bus again, so that devices are found even if udev does not announce
/// them. Throws DeviceError.
UsbContext make_usb_context();

/// Returns the devices with `vendor` and `product`. Reads only descriptors that the system has
/// stored. Throws DeviceError when there is no access to the bus.
std::vector<UsbDeviceInfo> list_usb_devices(uint16_t vendor, uint16_t product);

/// The USB ID of a board and its endpoints, all on interface 0.
struct UsbId {
  uint16_t vendor = 0;  ///< 0: the board is not on USB
  uint16_t product = 0;
  uint8_t out = 0;
  uint8_t in = 0;
  bool interrupt = false;   ///< otherwise bulk
  bool shared = false;      ///< other devices have this id, too, so each of them must be identified
  bool full_speed = false;  ///< 12 Mbit/s, packets of 64 bytes; otherwise 480 and 512

  std::string text() const;
};

/// Transport over USB, with libusb. All transfers of an exchange are submitted to the kernel at
/// once, the reply's first, so that an exchange takes one round trip on the bus. The thread that
/// exchanges also handles the events. At the deadline it cancels transfers and waits for their end,
/// which may take any time in libusb and the kernel. Do not use this class in a thread that must
/// not wait; see boards::StringLink.
class UsbTransport final : public Transport {
 public:
  /// `name` is for messages.
  UsbTransport(std::string name, const UsbId& id);
  ~UsbTransport() override;

  /// Selects the device that open() opens.
  void select(const UsbDeviceInfo& device) { device_ = device; }

  void open() override;
  LinkFault control(const VendorRequest& request, int64_t deadline_ns) noexcept override;
  void recover() noexcept override;
  std::string where() const override { return "at " + device_.path + ": "; }
  std::optional<LastWill> last_will() const override;
  void close() noexcept override;

 private:
  Transfer transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t deadline_ns) noexcept override;
  static constexpr size_t kMaxPackets = 2;
  static constexpr size_t kMaxLength = 512;

  struct Slot {
    libusb_transfer* transfer = nullptr;
    std::array<uint8_t, kMaxLength> bytes{};
    int done = 1;  // type required by libusb; 1: not in flight
  };

  LinkFault submit(Slot& slot, uint8_t endpoint, size_t length) noexcept;
  void finish(int64_t deadline_ns) noexcept;
  bool in_flight() const noexcept;

  const std::string name_;
  const UsbId id_;
  UsbDeviceInfo device_;
  UsbContext context_{nullptr, nullptr};
  libusb_device_handle* handle_ = nullptr;
  bool out_stalled_ = false;
  std::array<Slot, kMaxPackets + 1> slots_;  ///< the last one is the reply's
};

}  // namespace spidar
