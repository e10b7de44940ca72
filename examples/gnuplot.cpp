// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "examples/gnuplot.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace {

/// A gnuplot string in single quotes. These have no escapes: a quote is doubled.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

}  // namespace

void run_gnuplot(const std::string& script,
                 const std::vector<std::pair<std::string, std::string>>& variables) {
  std::vector<std::string> arguments = {"gnuplot"};
  for (const auto& [name, value] : variables) {
    arguments.insert(arguments.end(), {"-e", name + "=" + quoted(value)});
  }
  arguments.push_back(std::string(EXAMPLES_DIR) + "/" + script);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);

  setenv("LC_ALL", "C.UTF-8", 1);  // else gnuplot complains about the units in its scripts

  pid_t child = 0;
  int status = posix_spawnp(&child, argv[0], nullptr, nullptr, argv.data(), environ);
  if (status != 0) {
    throw std::runtime_error(std::string("gnuplot: ") + std::strerror(status) +
                             " (Debian package gnuplot-nox)");
  }
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) throw std::runtime_error("gnuplot could not draw " + script + ", see above");
}
