// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <atomic>
#include <cstdlib>
#include <fcntl.h>
#include <optional>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <termios.h>
#include <thread>
#include <unistd.h>
#include <utility>

#include "spidar/devices/uart/emulated.h"

namespace spidar::test {

/// UART boards behind a pseudo-terminal, a serial line without hardware. Answers from a thread of
/// its own until it is destroyed, which hangs up the line.
class UartLine {
 public:
  explicit UartLine(emulated::Uart boards) : boards_(std::move(boards)) {
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0)
      throw std::runtime_error("no pseudo-terminal");
    path_ = ptsname(master_);
    // The line stays open for as long as the boards are there, as a real line does.
    slave_ = open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios settings{};
    tcgetattr(slave_, &settings);
    cfmakeraw(&settings);
    tcsetattr(slave_, TCSANOW, &settings);
    thread_ = std::thread([this] { run(); });
  }
  ~UartLine() {
    stop_ = true;
    thread_.join();
    close(slave_);
    close(master_);
  }

  const std::string& path() const { return path_; }
  /// Connects other boards behind the same adapter.
  void connect(emulated::Uart boards) {
    stop_ = true;
    thread_.join();
    stop_ = false;
    boards_.emplace(std::move(boards));
    thread_ = std::thread([this] { run(); });
  }
  /// Sets whether the boards neither receive nor answer.
  void set_silent(bool silent) { silent_ = silent; }

 private:
  void run() {
    std::array<uint8_t, 1024> bytes{};
    while (!stop_) {
      pollfd ready{master_, POLLIN, 0};
      if (poll(&ready, 1, 5) <= 0) continue;
      const ssize_t got = read(master_, bytes.data(), bytes.size());
      if (got <= 0 || silent_) continue;
      boards_->receive({bytes.data(), static_cast<size_t>(got)});
      const size_t reply = boards_->reply(bytes);
      if (reply > 0 && write(master_, bytes.data(), reply) < 0) return;
    }
  }

  int master_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  int slave_ = -1;
  std::string path_;
  std::optional<emulated::Uart> boards_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> silent_{false};
  std::thread thread_;
};

}  // namespace spidar::test
