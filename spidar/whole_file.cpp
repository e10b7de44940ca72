// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/whole_file.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <set>
#include <stdexcept>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "spidar/realtime/uninterrupted.h"

namespace spidar {

std::string read_regular_file(const std::string& path, size_t most_bytes) {
  struct File {
    const int descriptor;
    ~File() {
      if (descriptor >= 0) close(descriptor);
    }
  } const file{
      uninterrupted([&] { return open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK); })};
  struct stat status {};
  if (file.descriptor < 0 || fstat(file.descriptor, &status) != 0) {
    throw std::runtime_error(std::string("it cannot be read: ") + std::strerror(errno));
  }
  if (!S_ISREG(status.st_mode)) throw std::runtime_error("it is not a regular file");
  std::string text;
  char part[1 << 14];
  while (true) {
    const ssize_t got = uninterrupted([&] { return read(file.descriptor, part, sizeof part); });
    if (got < 0) {
      throw std::runtime_error(std::string("it cannot be read: ") + std::strerror(errno));
    }
    if (got == 0) return text;
    text.append(part, static_cast<size_t>(got));
    if (text.size() > most_bytes) {
      throw std::runtime_error("it has more than " + std::to_string(most_bytes >> 20) + " MiB");
    }
  }
}

namespace {

struct ReadFiles {
  std::mutex mutex;
  std::set<std::filesystem::path> paths;
};

ReadFiles& read_files() {
  static auto* const all = new ReadFiles;  // outlives threads that read
  return *all;
}

}  // namespace

void note_read(const std::filesystem::path& file) {
  const std::lock_guard<std::mutex> lock(read_files().mutex);
  read_files().paths.insert(file);
}

void expect_not_read(const std::filesystem::path& output) {
  const std::lock_guard<std::mutex> lock(read_files().mutex);
  for (const std::filesystem::path& file : read_files().paths) {
    std::error_code none;
    if (!std::filesystem::equivalent(file, output, none)) continue;
    throw std::runtime_error(output.string() + ": is to be another file than " + file.string() +
                             ", which is read");
  }
}

}  // namespace spidar
