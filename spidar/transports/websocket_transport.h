// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Exchange with a service of this computer that answers each message on a WebSocket with one.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "spidar/transports/transport.h"

namespace spidar {

/// libwebsockets does the work, in the thread that calls: its loop runs only inside of these
/// functions. It was preferred to libsoup, which aborts the process if the player has loaded
/// libsoup 2.4 as well.
///
/// A message is sent only when the one before has been answered. After a timeout the next exchange
/// waits for that answer first, and drops it, so that messages never queue up in the service.
class WebSocketTransport final : public Transport {
 public:
  /// `name` is for messages, `cure` what to do when nothing answers at the port.
  WebSocketTransport(std::string name, uint16_t port, std::string cure);
  ~WebSocketTransport() override;

  /// Waits for the message with which the service greets, and drops it.
  void open() override;
  Transfer exchange(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t deadline_ns) noexcept override;
  void recover() noexcept override;
  std::optional<LastWill> last_will() const override;
  void close() noexcept override;

 private:
  class Connection;

  const std::string name_;
  const uint16_t port_;
  const std::string cure_;
  std::unique_ptr<Connection> connection_;
};

}  // namespace spidar
