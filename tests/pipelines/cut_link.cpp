// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/pipelines/cut_link.h"

#include <array>
#include <cstdint>
#include <netinet/in.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

namespace spidar::test {
namespace {

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<uint16_t>(port));
  return address;
}

int bound_socket() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_in any = loopback(0);
  if (fd < 0 || bind(fd, reinterpret_cast<const sockaddr*>(&any), sizeof any) != 0)
    throw std::runtime_error("no UDP socket on the loopback interface");
  return fd;
}

}  // namespace

CutLink::CutLink(int to_port) : near_(bound_socket()), far_(bound_socket()) {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  getsockname(near_, reinterpret_cast<sockaddr*>(&address), &length);
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this, to_port] { pass_on(to_port); });
}

CutLink::~CutLink() {
  end_ = true;
  thread_.join();
  close(near_);
  close(far_);
}

void CutLink::pass_on(int to_port) {
  const sockaddr_in server = loopback(to_port);
  sockaddr_in caller{};
  std::array<char, 65536> packet;
  std::array<pollfd, 2> sockets = {pollfd{near_, POLLIN, 0}, pollfd{far_, POLLIN, 0}};
  while (!end_) {
    constexpr int kLook_ms = 20;  // for the end
    if (poll(sockets.data(), sockets.size(), kLook_ms) <= 0) continue;
    for (const pollfd& from : sockets) {
      if (!(from.revents & POLLIN)) continue;
      const bool is_near = from.fd == near_;
      sockaddr_in sender{};
      socklen_t length = sizeof sender;
      const ssize_t size = recvfrom(from.fd, packet.data(), packet.size(), 0,
                                    reinterpret_cast<sockaddr*>(&sender), &length);
      if (size < 0) continue;  // the other side's port is closed
      if (is_near) caller = sender;
      if (cut_ || (!is_near && caller.sin_port == 0)) continue;
      const sockaddr_in& to = is_near ? server : caller;
      sendto(is_near ? far_ : near_, packet.data(), static_cast<size_t>(size), 0,
             reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
  }
}

}  // namespace spidar::test
