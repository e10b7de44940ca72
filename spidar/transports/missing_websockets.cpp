// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The WebSocketTransport of a build without libwebsockets: it cannot be opened.
#include "spidar/device.h"
#include "spidar/transports/websocket_transport.h"

namespace spidar {

class WebSocketTransport::Connection {};

WebSocketTransport::WebSocketTransport(std::string name, uint16_t port, std::string cure)
    : name_(std::move(name)), port_(port), cure_(std::move(cure)) {}

WebSocketTransport::~WebSocketTransport() = default;

void WebSocketTransport::open() {
  throw DeviceError(
      name_ +
          ": this build of gst-spidar cannot reach services: install libwebsockets-dev "
          "and build it with -Dwebsockets=enabled",
      DeviceErrorCode::kSettings);
}

Transfer WebSocketTransport::transfer(std::initializer_list<ByteView>, MutableBytes,
                                      int64_t) noexcept {
  return {LinkFault::kGone, 0};
}

Transport::StaleData WebSocketTransport::drop_stale_data(int64_t) noexcept {
  return StaleData::kNone;
}

void WebSocketTransport::recover() noexcept {}

std::optional<LastWill> WebSocketTransport::last_will() const {
  return std::nullopt;
}

void WebSocketTransport::close() noexcept {}

}  // namespace spidar
