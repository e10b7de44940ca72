// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/tools/gnuplot.h"

#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace spidar {

Gnuplot::Gnuplot(int out) : warnings_(std::tmpfile(), std::fclose) {
  if (!warnings_) throw std::runtime_error(std::string("gnuplot: ") + std::strerror(errno));
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw std::runtime_error(std::string("gnuplot: ") + std::strerror(errno));
  }
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, fileno(warnings_.get()), STDERR_FILENO);
  // The signals that this program blocks or ignores are to end gnuplot.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, pipe_signal;
  sigemptyset(&none);
  sigemptyset(&pipe_signal);
  sigaddset(&pipe_signal, SIGPIPE);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &pipe_signal);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::string name = "gnuplot";
  char* const arguments[] = {name.data(), nullptr};
  const int error = posix_spawnp(&process_, name.c_str(), &files, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  close(ends[0]);
  if (error != 0) {
    close(ends[1]);
    throw std::runtime_error(std::string("gnuplot: ") + std::strerror(error) +
                             "; it is in the Debian package gnuplot-nox");
  }
  input_ = fdopen(ends[1], "w");
}

Gnuplot::~Gnuplot() {
  end();
}

void Gnuplot::finish() {
  if (end() != 0) throw std::runtime_error("gnuplot could not draw the picture" + warning());
}

/// The last line that it wrote. Its warnings, of fonts for example, do not matter if it succeeds.
std::string Gnuplot::warning() const {
  std::rewind(warnings_.get());
  std::string last;
  char line[256];
  while (std::fgets(line, sizeof line, warnings_.get())) {
    std::string text = line;
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    if (!text.empty()) last = ": " + text;
  }
  return last;
}

/// Its status, as waitpid() reports it; 0 when it has ended before.
int Gnuplot::end() {
  if (!input_) return 0;
  std::fclose(input_);
  input_ = nullptr;
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

}  // namespace spidar
