// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <memory>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "spidar/transports/transport.h"

namespace spidar {

/// Whether a program listens at this TCP port of the loopback. Connects to the port for a moment.
inline bool is_listening(uint16_t port) {
  constexpr timeval kSendTimeout{0, 100'000};  // for a listener whose queue is full
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  setsockopt(file, SOL_SOCKET, SO_SNDTIMEO, &kSendTimeout, sizeof kSendTimeout);
  const bool listening =
      connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(file);
  return listening;
}

/// A WebSocket connection to a service on this computer that answers each message with one message.
/// libwebsockets works in the calling thread: its event loop runs only inside these functions. It
/// was preferred to libsoup, which aborts the process if the player has loaded libsoup 2.4 as well.
///
/// A message is sent only after the answer to the previous one. After a timeout the next exchange
/// waits for that answer first, and drops it, so that messages never queue up in the service. A
/// message counts as the answer if it has begun to arrive after the request was written.
class WebSocketTransport final : public Transport {
 public:
  /// `name` is for error messages; `cure` says what to do when nothing answers at the port.
  WebSocketTransport(std::string name, uint16_t port, std::string cure);
  ~WebSocketTransport() override;

  /// Waits for the message with which the service greets, and drops it.
  void open() override;
  void recover() noexcept override;
  std::optional<LastWill> last_will() const override;
  void close() noexcept override;

 private:
  Transfer transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t deadline_ns) noexcept override;
  StaleData drop_stale_data(int64_t until_ns) noexcept override;
  class Connection;

  const std::string name_;
  const uint16_t port_;
  const std::string cure_;
  std::unique_ptr<Connection> connection_;
};

}  // namespace spidar
