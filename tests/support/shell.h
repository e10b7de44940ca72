// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdio>
#include <string>
#include <sys/wait.h>

namespace spidar::test {

struct CommandResult {
  int status = -1;  ///< −1 if the shell was killed or could not be started
  std::string text;
};

/// Runs a command; `text` is the standard output.
inline CommandResult run_shell(const std::string& command) {
  CommandResult outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return outcome;
  char part[4096];
  while (std::fgets(part, sizeof part, pipe)) outcome.text += part;
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  return outcome;
}

/// Runs a command; `text` also has the standard error of the last command.
inline CommandResult run(const std::string& command) {
  return run_shell(command + " 2>&1");
}

}  // namespace spidar::test
