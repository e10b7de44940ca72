// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "apps/gnuplot.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
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

/// gnuplot reports no error when the disk is full.
void check_png(const std::string& path) {
  const std::string end("\0\0\0\0IEND\xAE\x42\x60\x82", 12);
  std::string read(end.size(), ' ');
  std::ifstream file(path, std::ios::binary);
  file.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
  file.read(read.data(), static_cast<std::streamsize>(read.size()));
  if (read != end) {
    throw std::runtime_error(path + ": cannot be written as a whole; the disk may be full");
  }
}

}  // namespace

void run_gnuplot(const std::string& script, const GnuplotStrings& files,
                 const GnuplotStrings& texts) {
  std::vector<std::string> arguments = {"gnuplot"};
  const auto set = [&arguments](const std::string& name, const std::string& value) {
    arguments.insert(arguments.end(), {"-e", name + "=" + quoted(value)});
  };
  for (const auto& [name, text] : texts) set(name, text);
  for (const auto& [name, path] : files) {
    // An absolute name cannot begin with | or <, after which gnuplot expects a command to run.
    set(name, path.empty() ? path : std::filesystem::absolute(path).string());
  }
  arguments.push_back(std::string(APPS_DIR) + "/" + script);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);

  setenv("LC_ALL", "C.UTF-8", 1);  // else gnuplot does not know the units in its scripts

  pid_t child = 0;
  int status = posix_spawnp(&child, argv[0], nullptr, nullptr, argv.data(), environ);
  if (status != 0) {
    throw std::runtime_error(std::string("gnuplot: ") + std::strerror(status) +
                             " (Debian package gnuplot-nox)");
  }
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) throw std::runtime_error("gnuplot could not draw " + script + ", see above");
  for (const auto& [name, path] : files) {
    if (std::filesystem::path(path).extension() == ".png") check_png(path);
  }
}
