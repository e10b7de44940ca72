// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// A link over UDP that can be cut: packets of the loopback interface are passed on, or lost.
#pragma once

#include <atomic>
#include <thread>

namespace spidar::test {

/// Throws std::runtime_error when it has no socket.
class CutLink {
 public:
  /// Passes what comes at port() on to `to_port`, and its answers back to who sent last.
  explicit CutLink(int to_port);
  ~CutLink();
  CutLink(const CutLink&) = delete;
  CutLink& operator=(const CutLink&) = delete;

  int port() const { return port_; }
  /// While it is cut, packets of both directions are lost.
  void cut(bool is_cut) { cut_ = is_cut; }

 private:
  void pass_on(int to_port);

  int near_ = -1, far_ = -1;  // sockets: towards who calls, and towards `to_port`
  int port_ = 0;
  std::atomic<bool> cut_{false}, end_{false};
  std::thread thread_;
};

}  // namespace spidar::test
