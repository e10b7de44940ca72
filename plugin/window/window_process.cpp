// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/window/window_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sys/socket.h>
#include <sys/wait.h>
#include <system_error>
#include <time.h>
#include <unistd.h>

#include "spidar/child_process.h"
#include "spidar/install_folder.h"
#include "spidar/realtime/uninterrupted.h"

namespace spidar::window {
namespace {

/// $SPIDAR_WINDOW, or the program that was built or installed with this plugin.
std::string program() {
  const char* const named = secure_getenv("SPIDAR_WINDOW");
  if (named && *named) return named;
  const std::filesystem::path beside = own_file().replace_filename("spidar-window");
  std::error_code error;
  const bool is_built_here =
      prefix_of(own_file()).empty() && std::filesystem::exists(beside, error);
  return is_built_here ? beside.string() : installed(SPIDAR_WINDOW_PATH).string();
}

}  // namespace

std::string Process::start() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return std::string("no socket: ") + std::strerror(errno);
  }
  const std::string path = program();
  // In a session of its own, Ctrl-C in a terminal reaches only the player.
  process_ = start_child(path, {path}, {{ends[1], STDIN_FILENO}},
                         POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  const int error = errno;
  ::close(ends[1]);
  if (process_ > 0) {
    socket_ = ends[0];
    return "";
  }
  ::close(ends[0]);
  return path + ": " + std::strerror(error);
}

std::string Process::finish(int patience_ms) {
  if (process_ < 0) return "";
  constexpr int kStep_ms = 5;
  int status = 0;
  pid_t ended = 0;
  for (int waited_ms = 0; ended == 0; waited_ms += kStep_ms) {
    ended = uninterrupted([&] { return waitpid(process_, &status, WNOHANG); });
    if (ended != 0) break;
    if (waited_ms == patience_ms / kStep_ms * kStep_ms) kill(process_, SIGKILL);
    const timespec step{0, kStep_ms * 1'000'000};
    nanosleep(&step, nullptr);
  }
  process_ = -1;
  // Where the application ignores SIGCHLD, the system keeps no status.
  if (ended < 0 || (WIFEXITED(status) && WEXITSTATUS(status) == 0)) return "";
  if (WIFEXITED(status)) return "ended with status " + std::to_string(WEXITSTATUS(status));
  const int number = WTERMSIG(status);
  return "was ended by the signal " + std::to_string(number) + " (" + strsignal(number) + ")";
}

Process::~Process() {
  if (process_ >= 0) finish(0);
}

}  // namespace spidar::window
