// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace spidar::window {

/// One end of the socket between a player and its window. A packet is a header with the protocol's
/// version and the length, that many bytes, and perhaps a file. No function blocks. One thread.
class Channel {
 public:
  /// The largest packet, and the most files that may wait. More means that the other end is broken.
  struct Limits {
    uint32_t bytes = 0;
    size_t files = 0;
  };
  /// A picture's report takes less. Its memory is mapped as soon as it arrives.
  static constexpr Limits kFromPlayer{64 << 20, 16};
  /// A thousand choices to save, 33 bytes each, with the path of their film. No files.
  static constexpr Limits kFromWindow{64 << 10, 0};

  /// Takes over the socket (AF_UNIX, SOCK_STREAM).
  Channel(int socket, const Limits& limits) : socket_(socket), limits_(limits) {}
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  /// Sends as much as the socket takes; flush() sends the rest. `file` is copied; below 0: none.
  void send(const std::vector<uint8_t>& bytes, int file = -1);
  void flush();
  bool has_unsent() const { return !unsent_.empty(); }

  /// Reads what has arrived; then there may be packets.
  void fill();
  /// Returns the oldest complete packet; nothing when there is none.
  std::optional<std::vector<uint8_t>> next();
  /// Returns the oldest file, which now belongs to the caller; below 0: there is none.
  int take_file();

  /// Whether the other end is closed or broken. Earlier packets can still be taken.
  bool is_gone() const { return is_gone_; }
  /// Whether the other end sends something other than packets of this version of the protocol.
  bool is_incompatible() const { return is_incompatible_; }
  int socket() const { return socket_; }

 private:
  struct Unsent {
    std::vector<uint8_t> bytes;
    size_t sent = 0;
    int file = -1;
  };
  bool send_some(Unsent& packet);
  void mark_incompatible() { is_gone_ = is_incompatible_ = true; }

  const int socket_;
  const Limits limits_;
  std::deque<Unsent> unsent_;
  std::vector<uint8_t> received_;
  size_t taken_ = 0;  ///< bytes of received_ that next() has returned
  std::deque<int> files_;
  bool is_gone_ = false;
  bool is_incompatible_ = false;
};

}  // namespace spidar::window
