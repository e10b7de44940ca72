// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Programs that this process starts.
#pragma once

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <string>
#include <sys/types.h>
#include <unistd.h>
#include <utility>
#include <vector>

extern char** environ;

namespace spidar {

constexpr int kDevNull = -1;

/// Starts the program at the path `program` with `words`, of which the first is its name. `files`
/// are descriptors of this process, or kDevNull, each with its number in the child; all other files
/// close on exec. `flags` are those of posix_spawnattr_setflags(): with POSIX_SPAWN_SETSIGMASK no
/// signal is blocked in the child, although threads of this library block all, and with
/// POSIX_SPAWN_SETSIGDEF none is ignored. As this process may have threads, nothing but
/// posix_spawn() happens between fork and exec. Returns the process, or −1 and errno.
inline pid_t start_child(const std::string& program, std::vector<std::string> words,
                         const std::vector<std::pair<int, int>>& files, int flags) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const auto& [file, number] : files) {
    if (file == kDevNull) {
      posix_spawn_file_actions_addopen(&actions, number, "/dev/null", O_RDWR, 0);
    } else {  // a descriptor that is copied to its own number stays open
      posix_spawn_file_actions_adddup2(&actions, file, number);
    }
  }
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, static_cast<short>(flags));
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = -1;
  const int error =
      posix_spawn(&process, program.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  errno = error;
  return error == 0 ? process : -1;
}

}  // namespace spidar
