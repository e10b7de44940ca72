// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <csignal>
#include <cstdlib>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace spidar::test {

/// An X server without a screen: Xvfb on a free display. While it lives, DISPLAY names it and
/// WAYLAND_DISPLAY is unset. No window may be open when it is created or destroyed.
class VirtualDisplay {
 public:
  VirtualDisplay() {
    // Servers that start at the same time may choose the same display; one of them then gives up.
    for (int attempt = 0; attempt < 20 && name_.empty(); ++attempt) {
      if (attempt > 0) usleep(50'000);
      start();
    }
    if (name_.empty()) return;
    setenv("DISPLAY", name_.c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
  }

  ~VirtualDisplay() {
    unsetenv("DISPLAY");
    stop();
  }
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  /// One display for all windows of the process, because GLFW keeps its first one.
  static VirtualDisplay& shared() {
    static VirtualDisplay display;
    return display;
  }

  bool runs() const { return !name_.empty(); }
  static constexpr const char* kWhyNot = "Xvfb does not start: is the package xvfb installed?";

  /// Stops answering until thaw(), so its clients hang.
  void freeze() const { signal(SIGSTOP); }
  void thaw() const { signal(SIGCONT); }

 private:
  void signal(int number) const {
    if (process_ > 0) kill(process_, number);  // only this process is ours
  }

  void start() {
    int ends[2];
    if (pipe(ends) != 0) return;
    process_ = fork();
    if (process_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      const std::string display_fd = std::to_string(ends[1]);
      execlp("Xvfb", "Xvfb", "-displayfd", display_fd.c_str(), "-screen", "0", "1280x800x24",
             "-noreset", "-nolisten", "tcp", nullptr);
      _exit(127);
    }
    close(ends[1]);
    char number[16] = {};
    const ssize_t length = read(ends[0], number, sizeof number - 1);  // ends with a line break
    close(ends[0]);
    if (length >= 2) {
      name_ = ":" + std::string(number, static_cast<size_t>(length) - 1);
    } else {
      stop();
    }
  }

  void stop() {
    if (process_ <= 0) return;
    signal(SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = -1;
  }

  pid_t process_ = -1;
  std::string name_;
};

}  // namespace spidar::test
