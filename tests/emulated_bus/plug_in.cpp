// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Plugs an emulated board in for one command, or for a shell, and says what its motor outputs do:
// to rehearse what is done with a real board (docs/first-power-on.md). Its strings do not answer,
// as with motors that have no supply.
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/shared_bus.h"

namespace {

using namespace spidar::test;
using Digits = std::array<int, 8>;

constexpr const char* kUsage =
    "usage: plug_in BOARD [COMMAND [ARGUMENT]...]\n"
    "BOARD is sh4, simple or another that is on USB. Without COMMAND, a shell. The outputs of the "
    "board are printed when they have changed and stay.\n";

Digits outputs(const UsbPort& port) {
  Digits digits{};
  for (size_t i = 0; i < digits.size(); ++i) digits[i] = port.digit[i];
  return digits;
}

void print(const Digits& digits) {
  std::fprintf(stderr, "outputs of the board, digits:");
  for (const int digit : digits) std::fprintf(stderr, " %4d", digit);
  std::fprintf(stderr, "\n");
}

pid_t start(char** command) {
  const pid_t child = fork();
  if (child != 0) return child;
  setenv("LD_PRELOAD", EMULATED_BUS_LIBRARY, 1);
  setenv("SPIDAR_GUARDIAN", EMULATED_GUARDIAN, 1);
  execvp(command[0], command);
  std::fprintf(stderr, "plug_in: %s: %s\n", command[0], std::strerror(errno));
  _exit(127);
}

}  // namespace

int main(int argc, char** argv) {
  const SharedBus shared;
  try {
    plug(0, argc > 1 ? argv[1] : "", "EMULATED");
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "plug_in: %s\n%s", error.what(), kUsage);
    return 2;
  }
  const UsbPort& port = bus().port[0];
  const char* const shell = std::getenv("SHELL");
  std::array<char*, 2> interactive{const_cast<char*>(shell ? shell : "/bin/sh"), nullptr};
  const pid_t child = start(argc > 2 ? argv + 2 : interactive.data());
  Digits shown{}, last{};
  int status = 0;
  bool ended = false;
  // A tenth of a second more, in which the guardian has to act.
  for (int rest = 10; rest > 0; rest -= ended) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    // Of a ramp only the end.
    const Digits now = outputs(port);
    if (now == last && now != shown) print(shown = now);
    last = now;
    ended = ended || waitpid(child, &status, WNOHANG) == child;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
