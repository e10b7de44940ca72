// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Small files that a user names, as text.
#pragma once

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <stdexcept>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

namespace spidar {

/// All of a file of at most `most_bytes`. Throws std::runtime_error, which says what is wrong as
/// the end of a sentence ("it is not a regular file"), also when the system calls it regular, but
/// does not let it be read, as with /proc/self/mem.
inline std::string read_regular_file(const std::string& path, size_t most_bytes) {
  struct File {
    const int descriptor;
    ~File() {
      if (descriptor >= 0) close(descriptor);
    }
  } const file{open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  struct stat status {};
  if (file.descriptor < 0 || fstat(file.descriptor, &status) != 0)
    throw std::runtime_error(std::string("it cannot be read: ") + std::strerror(errno));
  if (!S_ISREG(status.st_mode)) throw std::runtime_error("it is not a regular file");
  std::string text;
  char part[1 << 14];
  while (true) {
    const ssize_t got = read(file.descriptor, part, sizeof part);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0)
      throw std::runtime_error(std::string("it cannot be read: ") + std::strerror(errno));
    if (got == 0) return text;
    text.append(part, static_cast<size_t>(got));
    if (text.size() > most_bytes)
      throw std::runtime_error("it has more than " + std::to_string(most_bytes >> 20) + " MiB");
  }
}

}  // namespace spidar
