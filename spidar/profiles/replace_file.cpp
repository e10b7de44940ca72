// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "spidar/profiles/profile_file.h"
#include "spidar/replaced_file.h"

namespace spidar {
namespace {

bool write_all(int file, const std::string& text) {
  for (size_t done = 0; done < text.size();) {
    const ssize_t written = write(file, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    done += static_cast<size_t>(written);
  }
  return fsync(file) == 0;
}

}  // namespace

void replace_file(const std::filesystem::path& named_file, const std::string& text) {
  std::filesystem::path file;
  try {
    file = place_of_output(named_file);
  } catch (const std::runtime_error& error) {
    throw ProfileError(error.what());
  }
  // Its name does not depend on that of the file, which may be as long as the system allows.
  const std::string part = file.parent_path() / (".spidar-" + std::to_string(getpid()) + ".part");
  const auto fail = [&] {
    throw ProfileError(file.string() + ": cannot be written: " + std::strerror(errno));
  };
  struct stat named {};
  if (lstat(file.c_str(), &named) == 0 && !S_ISREG(named.st_mode))
    throw ProfileError(file.string() + ": cannot be written: it is no regular file");
  const int opened = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (opened < 0) fail();
  keep_permissions(opened, file);
  const bool written = write_all(opened, text);
  int error = written ? 0 : errno;
  if (close(opened) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(part.c_str(), file.c_str()) != 0) error = errno;
  if (error == 0) return;
  unlink(part.c_str());
  errno = error;
  fail();
}

}  // namespace spidar
