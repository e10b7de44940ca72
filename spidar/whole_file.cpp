// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/whole_file.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <set>
#include <stdexcept>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <system_error>
#include <unistd.h>
#include <vector>

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

std::filesystem::path place_of_output(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const std::filesystem::path place = std::filesystem::canonical(path, error);
  if (!error) return place;
  throw std::runtime_error(path.string() + ": cannot be written: it is a link to " +
                           std::filesystem::read_symlink(path, error).string() +
                           ", which is not there; remove the link");
}

void keep_permissions(int file, const std::filesystem::path& path) {
  struct stat before {};
  if (stat(path.c_str(), &before) != 0) return;
  // The mode comes last: a new owner takes bits away, and a group that may not be given gets none.
  const bool has_group = fchown(file, static_cast<uid_t>(-1), before.st_gid) == 0;
  [[maybe_unused]] const int owner = fchown(file, before.st_uid, static_cast<gid_t>(-1));
  fchmod(file, before.st_mode & (has_group ? 0777U : 0707U));
  constexpr const char* kAcl = "system.posix_acl_access";
  const ssize_t bytes = getxattr(path.c_str(), kAcl, nullptr, 0);
  if (bytes <= 0) return;
  std::vector<char> acl(static_cast<size_t>(bytes));
  if (getxattr(path.c_str(), kAcl, acl.data(), acl.size()) == bytes) {
    fsetxattr(file, kAcl, acl.data(), acl.size(), 0);
  }
}

namespace {

bool write_all(int file, const std::string& text) {
  for (size_t done = 0; done < text.size();) {
    const ssize_t written =
        uninterrupted([&] { return write(file, text.data() + done, text.size() - done); });
    if (written <= 0) return false;
    done += static_cast<size_t>(written);
  }
  return uninterrupted([&] { return fsync(file); }) == 0;
}

}  // namespace

void replace_file(const std::filesystem::path& named_file, const std::string& text) {
  const std::filesystem::path file = place_of_output(named_file);
  const auto fail = [&] {
    throw std::runtime_error(file.string() + ": cannot be written: " + std::strerror(errno));
  };
  struct stat named {};
  if (lstat(file.c_str(), &named) == 0 && !S_ISREG(named.st_mode)) {
    throw std::runtime_error(file.string() + ": cannot be written: it is no regular file");
  }
  std::error_code ignored;
  const std::filesystem::path folder = file.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
    throw std::runtime_error(file.string() + ": cannot be written: there is no folder " +
                             folder.string());
  }
  // Its name does not depend on that of the file, which may be as long as the system allows. It is
  // a new one for each save: another thread, or a process of this number that was killed, has used
  // others.
  static std::atomic<unsigned> saves{0};
  const std::string name = ".spidar-" + std::to_string(getpid()) + "-";
  std::string part;
  int opened = -1;
  do {
    part = folder / (name + std::to_string(saves++) + ".part");
    opened = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  } while (opened < 0 && errno == EEXIST);
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
