// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// spidarctl as a user sees it: exit status, messages, files.
#pragma once

#include <unistd.h>

#include "tests/support/messages.h"
#include "tests/support/shell.h"
#include "tests/support/test.h"

namespace spidar::test {

inline CommandResult run_spidarctl(const std::string& arguments) {
  return run_shell(std::string(SPIDARCTL) + " " + arguments + " 2>&1");
}

/// Removed at the end.
class OutputFile {
 public:
  OutputFile()
      : path_((std::filesystem::temp_directory_path() /
               ("spidarctl-" + std::to_string(getpid()) + ".toml"))
                  .string()) {}
  ~OutputFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace spidar::test
