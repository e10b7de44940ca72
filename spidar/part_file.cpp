// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/part_file.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <pthread.h>
#include <semaphore.h>
#include <set>
#include <stdexcept>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "spidar/realtime/uninterrupted.h"
#include "spidar/whole_file.h"

namespace spidar {
namespace {

constexpr const char* kAttribute = "user.gst-spidar.written";

std::string mark_of(const struct stat& file, const std::string& maker) {
  return maker + " " + std::to_string(file.st_size) + " " + std::to_string(file.st_mtim.tv_sec) +
         " " + std::to_string(file.st_mtim.tv_nsec);
}

/// Returns an empty text when there is none.
std::string found_mark(const std::string& path) {
  constexpr size_t kMax_bytes = 256;
  std::string found(kMax_bytes, '\0');
  const ssize_t bytes = getxattr(path.c_str(), kAttribute, found.data(), found.size());
  return found.substr(0, static_cast<size_t>(std::max<ssize_t>(bytes, 0)));
}

/// Whether `maker` has written the file at `path`, even if its content has been changed.
bool is_written_by(const std::string& path, const std::string& maker) {
  return found_mark(path).compare(0, maker.size() + 1, maker + " ") == 0;
}

namespace fs = std::filesystem;

/// The part files of this process. The lock is held while one is made, renamed or removed, so that
/// a signal finds all of them.
struct Registry {
  std::mutex mutex;
  std::set<std::string> paths;
};

Registry& registry() {
  static auto* const all = new Registry;  // outlives the thread that waits for signals
  return *all;
}

std::runtime_error failure(const fs::path& target, int error) {
  const fs::path folder = target.parent_path();
  std::error_code none;
  if (!folder.empty() && !fs::is_directory(folder, none)) {
    return std::runtime_error(
        target.string() + ": cannot be written: there is no folder " + folder.string() +
        (target.string().find("://") == std::string::npos ? ""
                                                          : "; a file name is needed, not a URI"));
  }
  return std::runtime_error(target.string() + ": cannot be written: " + std::strerror(error));
}

/// Whether the open file still has this name.
bool is_at(int descriptor, const std::string& path) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && lstat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Removes what a killed process has left at `path`. Returns false when its owner lives. Throws
/// std::runtime_error, which names `target`.
bool remove_left(const std::string& path, const fs::path& target) {
  const int left = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (left < 0 && errno == ENOENT) return true;
  struct stat status {};
  if (left < 0 || fstat(left, &status) != 0 || !S_ISREG(status.st_mode)) {
    if (left >= 0) close(left);
    throw std::runtime_error(target.string() + ": cannot be written while there is " + path +
                             ", which is not a file of this program; remove it");
  }
  // Some network file systems have no locks: there, only this process is kept from writing twice.
  const bool is_owned = flock(left, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (!is_owned && is_at(left, path)) unlink(path.c_str());
  close(left);
  return !is_owned;
}

/// Makes a new, open and locked file; −1 when another process has locked it. Throws
/// std::runtime_error, which names `target`.
int make_locked(const std::string& path, const fs::path& target) {
  for (;;) {
    const int descriptor = uninterrupted([&] {
      return open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    });
    if (descriptor < 0 && errno != EEXIST) throw failure(target, errno);
    if (descriptor < 0) {
      if (!remove_left(path, target)) return -1;
      continue;
    }
    // Before the lock, another process may take the file for an abandoned one and remove it.
    uninterrupted([&] { return flock(descriptor, LOCK_EX); });
    if (is_at(descriptor, path)) return descriptor;
    close(descriptor);
  }
}

/// The name is the same in every process and on every machine: FNV-1a, 64 bits
/// (draft-eastlake-fnv).
std::string part_path(const fs::path& place) {
  uint64_t hash = 0xcbf29ce484222325;
  for (const char c : place.filename().string()) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  char name[32];
  std::snprintf(name, sizeof name, ".part-%016" PRIx64, hash);
  return (place.parent_path() / name).string() + place.extension().string();
}

/// The file to write for `path`: the target of a link, so that the link stays; otherwise `path`.
/// Throws std::runtime_error for a link that leads to nothing.
fs::path place_of_output(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  const fs::path place = fs::canonical(path, error);
  if (!error) return place;
  throw std::runtime_error(path.string() + ": cannot be written: it is a link to " +
                           fs::read_symlink(path, error).string() +
                           ", which is not there; remove the link");
}

/// Gives the open file the permissions of the one at `path`, if any, with its access control list,
/// and its owner as far as this user may.
void keep_permissions(int file, const std::string& path) {
  struct stat before {};
  if (stat(path.c_str(), &before) != 0) return;
  // The mode comes last: a new owner clears bits, and a group that was not set gets no access.
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

volatile std::sig_atomic_t received_signal = 0;
sem_t has_received;

/// Any thread may receive the signal: libraries that start threads before main() block no signals
/// in these (OpenBLAS).
void receive_signal(int number) {
  received_signal = number;
  sem_post(&has_received);
}

/// Waits for one of the signals, removes the part files, and ends the program as the signal does.
void await_signal(const sigset_t& signals) {
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  while (sem_wait(&has_received) != 0) {  // interrupted, by the signal itself
  }
  registry().mutex.lock();  // forever: no more part files are made
  for (const std::string& path : registry().paths) unlink(path.c_str());
  std::signal(received_signal, SIG_DFL);
  kill(getpid(), received_signal);
}

}  // namespace

void mark_written(int file, const std::string& maker) {
  struct stat now {};
  if (fstat(file, &now) != 0) return;
  const std::string mark = mark_of(now, maker);
  fsetxattr(file, kAttribute, mark.data(), mark.size(), 0);
}

bool is_as_written(const std::string& path, const std::string& maker) {
  struct stat now {};
  return stat(path.c_str(), &now) == 0 && found_mark(path) == mark_of(now, maker);
}

PartFile::PartFile(const fs::path& target, const Replaces& replaces) : PartFile() {
  if (!try_claim(target, replaces)) {
    throw std::runtime_error(target.string() + ": another process is writing it");
  }
  if (may_replace()) return;
  const std::string& maker = replaces.maker;
  if (!replaces.is_named && replaces.any) {
    throw std::runtime_error(target.string() + ": exists, and nothing says that " + maker +
                             " has made it; name another place, or remove it");
  }
  throw std::runtime_error(target.string() + ": exists" +
                           (maker.empty() ? "" : ", and is not as " + maker + " left it") +
                           "; name another file, or replace it with --force");
}

PartFile::PartFile(const fs::path& target, int descriptor)
    : target_(target.string()), place_(place_of_output(target).string()), descriptor_(descriptor) {
  path_ = part_path(place_);
}

PartFile::~PartFile() {
  if (descriptor_ < 0) return;
  const std::lock_guard<std::mutex> lock(registry().mutex);
  if (registry().paths.erase(path_) > 0) unlink(path_.c_str());
  close(descriptor_);
}

std::unique_ptr<PartFile> PartFile::claim(const fs::path& target, const Replaces& replaces) {
  std::unique_ptr<PartFile> file(new PartFile);
  if (!file->try_claim(target, replaces)) file.reset();
  return file;
}

bool PartFile::may_replace() const {
  std::error_code none;
  if (!fs::exists(place_, none)) return true;
  if (replaces_.any) return replaces_.is_named || is_written_by(place_, replaces_.maker);
  return !replaces_.maker.empty() && is_as_written(place_, replaces_.maker);
}

bool PartFile::try_claim(const fs::path& target, const Replaces& replaces) {
  std::error_code none;
  if (fs::exists(target, none) && !fs::is_regular_file(target, none)) {
    throw std::runtime_error(target.string() + ": cannot be written: it is not a regular file");
  }
  if (!replaces.is_read) expect_not_read(target);
  target_ = target.string();
  place_ = place_of_output(target).string();
  path_ = part_path(place_);
  replaces_ = replaces;
  if (access(place_.c_str(), W_OK) != 0 && errno == EACCES) {
    throw std::runtime_error(target_ + ": is protected against writing");
  }
  const std::lock_guard<std::mutex> lock(registry().mutex);
  if (registry().paths.count(path_) > 0) return false;
  descriptor_ = make_locked(path_, target);
  if (descriptor_ < 0) return false;
  registry().paths.insert(path_);
  return true;
}

void PartFile::check_in_place() const {
  struct stat named {};
  if (lstat(path_.c_str(), &named) != 0) throw failure(target_, errno);
  if (is_at(descriptor_, path_)) return;
  throw std::runtime_error(target_ + ": another program has replaced " + path_);
}

void PartFile::write(const std::string& content) {
  for (size_t at = 0; at < content.size();) {
    const ssize_t written = uninterrupted([&] {
      return pwrite(descriptor_, content.data() + at, content.size() - at,
                    static_cast<off_t>(written_));
    });
    if (written < 0) throw failure(target_, errno);
    at += static_cast<size_t>(written);
    written_ += static_cast<uint64_t>(written);
  }
}

std::string PartFile::publish() {
  keep_permissions(descriptor_, place_);
  if (!replaces_.maker.empty()) mark_written(descriptor_, replaces_.maker);
  // Some file systems notice only now that the disk is full.
  const bool is_kept = uninterrupted([&] { return fsync(descriptor_); }) == 0;
  if (!is_kept && errno != EINVAL) throw failure(target_, errno);
  const std::lock_guard<std::mutex> lock(registry().mutex);
  check_in_place();
  if (!replaces_.is_read) expect_not_read(place_);  // this program may have read it since
  if (!may_replace()) throw failure(target_, EEXIST);
  struct stat before {};
  const bool is_there = stat(place_.c_str(), &before) == 0;
  const unsigned flags = is_there ? 0 : RENAME_NOREPLACE;
  int status = renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, place_.c_str(), flags);
  if (status != 0 && errno == EINVAL) {  // not every file system knows the flag
    if (!is_there && fs::exists(place_)) throw failure(target_, EEXIST);
    status = std::rename(path_.c_str(), place_.c_str());
  }
  if (status != 0) throw failure(target_, errno);
  registry().paths.erase(path_);
  return is_there && before.st_nlink > 1 ? "what was there stays under its other names (hard links)"
                                         : "";
}

void replace_file(const fs::path& file, const std::string& text) {
  constexpr std::chrono::milliseconds kStep{1};
  constexpr int kLongest_steps = 1000;  // another save takes some milliseconds
  PartFile::Replaces replaces{true, {}};
  replaces.is_read = true;
  auto part = PartFile::claim(file, replaces);
  for (int step = 0; !part && step < kLongest_steps; ++step) {
    std::this_thread::sleep_for(kStep);
    part = PartFile::claim(file, replaces);
  }
  if (!part) throw std::runtime_error(file.string() + ": another process is writing it");
  part->write(text);
  part->publish();
}

void remove_part_files_on_signals() {
  for (const int number : {SIGPIPE, SIGXFSZ}) std::signal(number, SIG_IGN);
  sem_init(&has_received, 0, 0);
  sigset_t signals;
  sigemptyset(&signals);
  // If both limits of CPU time were equal, only SIGKILL would be sent.
  rlimit cpu{};
  if (getrlimit(RLIMIT_CPU, &cpu) == 0 && cpu.rlim_cur == cpu.rlim_max && cpu.rlim_cur > 1 &&
      cpu.rlim_cur != RLIM_INFINITY) {
    --cpu.rlim_cur;
    setrlimit(RLIMIT_CPU, &cpu);
  }
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    struct sigaction present {};
    sigaction(number, nullptr, &present);
    if (present.sa_handler == SIG_IGN) continue;  // as nohup does with SIGHUP
    sigaddset(&signals, number);
    std::signal(number, receive_signal);
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread(await_signal, signals).detach();
}

}  // namespace spidar
