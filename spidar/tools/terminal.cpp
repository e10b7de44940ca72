// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/tools/terminal.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <unistd.h>

#include "spidar/loop/haptic_loop.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/tools/command_line.h"

namespace spidar {
namespace {

std::atomic<bool> signalled{false};

}  // namespace

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) { signalled = true; };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
}

bool interrupted() {
  return signalled;
}

Pace every_millisecond() {
  return [next_ns = monotonic_now_ns()]() mutable {
    next_ns = std::max(next_ns + kTick_ns, monotonic_now_ns());
    sleep_until_ns(next_ns);
    return !interrupted();
  };
}

bool confirm(const std::string& question) {
  if (isatty(STDIN_FILENO) == 0)
    throw UsageError(
        "there is no terminal to ask for confirmation; use --yes to continue without it");
  std::cerr << question << " [y/N] " << std::flush;
  std::string answer;
  return std::getline(std::cin, answer) && (answer == "y" || answer == "Y" || answer == "yes");
}

void check_folder_of(const std::string& file) {
  const std::filesystem::path parent = std::filesystem::absolute(file).parent_path();
  if (access(parent.c_str(), W_OK) != 0)
    throw ProfileError(file + ": cannot be written: " + parent.string() + ": " +
                       std::strerror(errno));
}

}  // namespace spidar
