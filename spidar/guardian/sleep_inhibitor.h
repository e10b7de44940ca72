// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <array>
#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

#include "spidar/child_process.h"

namespace spidar {

/// The path of a program of systemd; empty when systemd is not running. $SPIDAR_SYSTEMD names
/// another folder for these programs; if that is empty, no program is used.
inline std::string systemd_program(const char* name) {
  const char* folder = secure_getenv("SPIDAR_SYSTEMD");
  // The same check as in sd_booted(3).
  if (!folder) folder = access("/run/systemd/system", F_OK) == 0 ? "/usr/bin" : "";
  return *folder ? std::string(folder) + "/" + name : std::string();
}

/// Keeps the machine from being suspended while motors pull. A suspension would freeze a host and
/// its guardian at the same time, so that nobody would set the motors to zero. systemd-inhibit
/// holds a lock of logind as long as its command runs. The command is a cat that reads from this
/// process, so the lock ends with this process. Without logind, or without permission, there is no
/// lock.
class SleepInhibitor {
 public:
  SleepInhibitor() = default;
  ~SleepInhibitor() { inhibit(false); }
  SleepInhibitor(const SleepInhibitor&) = delete;
  SleepInhibitor& operator=(const SleepInhibitor&) = delete;

  void inhibit(bool wanted) noexcept {
    while (process_ > 0 && waitpid(process_, nullptr, WNOHANG) != 0) process_ = -1;
    if (wanted == (pipe_ >= 0)) return;
    if (wanted) return start();
    ::close(pipe_);
    pipe_ = -1;
  }

 private:
  void start() noexcept {
    const std::string program = systemd_program("systemd-inhibit");
    std::array<int, 2> ends{};
    if (program.empty() || pipe2(ends.data(), O_CLOEXEC) != 0) return;
    pipe_ = ends[1];
    // Closing the lid suspends in spite of a lock of "sleep" alone (LidSwitchIgnoreInhibited).
    process_ =
        start_child(program,
                    {program, "--what=sleep:handle-lid-switch", "--mode=block", "--who=SPIDAR",
                     "--why=The motors of a haptic device are pulling", "cat"},
                    {{ends[0], STDIN_FILENO}, {kDevNull, STDOUT_FILENO}, {kDevNull, STDERR_FILENO}},
                    POSIX_SPAWN_SETSIGDEF);
    ::close(ends[0]);
  }

  int pipe_ = -1;  ///< −1: not wanted
  pid_t process_ = -1;
};

}  // namespace spidar
