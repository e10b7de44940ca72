// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Packets of USB/IP, on the device's side. Source: Documentation/usb/usbip_protocol.rst of Linux.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spidar::test {

/// Every packet begins with so many bytes; numbers are big-endian.
constexpr size_t kUsbipHeader = 48;
using UsbipHeader = std::array<uint8_t, kUsbipHeader>;

enum class UsbipCommand : uint32_t {
  kSubmit = 1,
  kUnlink = 2,
  kSubmitReply = 3,
  kUnlinkReply = 4,
};

/// What the kernel asks for.
struct UsbipRequest {
  UsbipCommand command = UsbipCommand::kSubmit;
  uint32_t sequence = 0;
  bool in = false;
  uint32_t endpoint = 0;  ///< without the bit for the direction
  uint32_t unlink = 0;    ///< kUnlink: sequence of the request to be given up
  uint32_t length = 0;    ///< kSubmit: of the data that follow (out) or may be replied (in)
  std::array<uint8_t, 8> setup{};
};

inline uint32_t usbip_number(const UsbipHeader& bytes, size_t at) noexcept {
  uint32_t number = 0;
  for (size_t i = 0; i < 4; ++i) number = number << 8 | bytes[at + i];
  return number;
}

inline void put_usbip_number(UsbipHeader& bytes, size_t at, uint32_t number) noexcept {
  for (size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<uint8_t>(number >> (24 - 8 * i));
}

inline UsbipRequest decode_usbip(const UsbipHeader& bytes) noexcept {
  UsbipRequest request;
  request.command = static_cast<UsbipCommand>(usbip_number(bytes, 0));
  request.sequence = usbip_number(bytes, 4);
  request.in = usbip_number(bytes, 12) == 1;
  request.endpoint = usbip_number(bytes, 16);
  if (request.command == UsbipCommand::kUnlink) {
    request.unlink = usbip_number(bytes, 20);
  } else {
    request.length = usbip_number(bytes, 24);
    for (size_t i = 0; i < request.setup.size(); ++i) request.setup[i] = bytes[40 + i];
  }
  return request;
}

/// `status`: 0 or a negative errno; `length`: bytes that were taken, or that follow.
inline UsbipHeader encode_usbip_reply(UsbipCommand command, uint32_t sequence, int status,
                                      size_t length = 0) noexcept {
  UsbipHeader bytes{};
  put_usbip_number(bytes, 0, static_cast<uint32_t>(command));
  put_usbip_number(bytes, 4, sequence);
  put_usbip_number(bytes, 20, static_cast<uint32_t>(status));
  put_usbip_number(bytes, 24, static_cast<uint32_t>(length));
  return bytes;
}

}  // namespace spidar::test
