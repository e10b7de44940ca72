// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Common parts of the command-line programs: arguments, errors and exit statuses.
#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <system_error>

namespace spidar::tools {

// Exit statuses, as the manual pages list them.
constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;
constexpr int kInterrupted = 130;  ///< 128 + SIGINT, as shells report it

/// Thrown for an invalid command line. what() says what was wrong and what would be right.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The exit status of a program that has printed to the standard output: `status`, or kFailed
/// instead of kDone if the output has not arrived, for example on a full disk. Prints an error
/// then, unless the reader of a pipe has left.
inline int status_after_printing(const std::string& program, int status) {
  errno = 0;
  std::cout.flush();
  std::fflush(stdout);
  if (std::cout.good() && std::ferror(stdout) == 0) return status;
  if (errno != EPIPE) {
    std::cerr << program << ": what is printed cannot be written; is the disk full?\n";
  }
  return status == kDone ? kFailed : status;
}

/// Puts "./" before names of files that begin with a dash, so that they are not taken for options,
/// if the name has a point and the file exists. Arguments after "--" may be properties.
inline void mark_files(int argc, char** argv, bool has_properties_last = true) {
  static std::deque<std::string> marked;  // lives as long as argv
  for (int i = 1; i < argc; ++i) {
    if (has_properties_last && std::strcmp(argv[i], "--") == 0) return;
    std::error_code none;
    if (argv[i][0] != '-' || !std::strchr(argv[i], '.') ||
        !std::filesystem::exists(argv[i], none)) {
      continue;
    }
    argv[i] = marked.emplace_back(std::string("./") + argv[i]).data();
  }
}

}  // namespace spidar::tools
