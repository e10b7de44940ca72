// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// What a desktop's player finds around it, and what can be seen of its processes.
#pragma once

#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/shell.h"

namespace spidar::test {

/// In $PATH.
bool is_installed(const std::string& program);

/// main() of a test whose players need a session: runs it again in a D-Bus session of its own, with
/// a home in a temporary folder and without what would make strangers' warnings fatal. `inner` is
/// the test there. Without dbus-run-session it runs in none; has_session_bus() is false then.
int run_in_session(int argc, char** argv, int (*inner)(int argc, char** argv));
bool has_session_bus();

/// Those that have the same $SPIDAR_EMULATED_BUS as this one and have loaded `library`.
std::set<int> processes_with(const std::string& library);

/// Presses a key in the newest window. False when there is none.
bool press(const std::string& key);

/// Waits until it is so; false when it is not within a minute, which is a hundred times what any
/// player needs to start.
template <typename Condition>
bool comes(const Condition& condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

}  // namespace spidar::test
