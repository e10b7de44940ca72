// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <csignal>
#include <spawn.h>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <vector>

extern char** environ;

namespace spidar::test {

class ChildProcess {
 public:
  /// Starts a program. `arguments` begin with the program, which is searched in $PATH;
  /// `environment` has more lines NAME=VALUE for it.
  explicit ChildProcess(std::vector<std::string> arguments,
                        std::vector<std::string> environment = {}) {
    std::vector<char*> argv, env;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    for (std::string& entry : environment) env.push_back(entry.data());
    for (char** entry = environ; *entry; ++entry) env.push_back(*entry);
    argv.push_back(nullptr);
    env.push_back(nullptr);
    if (posix_spawnp(&process_, argv[0], nullptr, nullptr, argv.data(), env.data()) != 0)
      throw std::runtime_error("cannot start " + arguments[0]);
  }
  ~ChildProcess() { end(SIGKILL); }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Sends the signal and returns when the process has ended.
  void end(int signal) {
    if (process_ < 0) return;
    kill(process_, signal);
    waitpid(process_, nullptr, 0);
    process_ = -1;
  }

  pid_t id() const { return process_; }

  /// Sends the signal and returns at once.
  void send(int signal) const { kill(process_, signal); }

  /// Waits for the process. Returns its exit status; −1 when a signal ended it.
  int wait() {
    int status = -1;
    waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  bool lives() {
    if (process_ > 0 && waitpid(process_, nullptr, WNOHANG) != 0) process_ = -1;
    return process_ > 0;
  }

 private:
  pid_t process_ = -1;
};

}  // namespace spidar::test
