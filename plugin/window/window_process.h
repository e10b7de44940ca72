// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// The program spidar-window as a child of this process.
#pragma once

#include <string>
#include <sys/types.h>

namespace spidar::window {

/// One thread, not necessarily the same for all functions.
class Process {
 public:
  Process() = default;
  /// Ends the child if it still runs.
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Starts $SPIDAR_WINDOW or the installed program. Returns an empty string, or why it cannot be
  /// started. socket() is then this process's end of its socket, which the caller takes over.
  std::string start();
  int socket() const { return socket_; }
  /// Waits until the child has ended, which is killed when that takes longer than `patience_ms`.
  /// Returns an empty string when it ended by itself, with status 0; else how: "was ended by the
  /// signal 11 (Segmentation fault)".
  std::string finish(int patience_ms);

 private:
  pid_t process_ = -1;
  int socket_ = -1;
};

}  // namespace spidar::window
