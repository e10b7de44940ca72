// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <string>
#include <string_view>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "spidar/realtime/uninterrupted.h"

namespace spidar {

/// Opens /dev/null for each of the descriptors 0 to 2 that is closed, as after `>&-` in a shell.
/// Otherwise the next file that the program opens gets that number, and output of the program or of
/// a library goes into that file. Call this before anything is opened.
inline void open_standard_descriptors() {
  int lowest_free = 0;
  do {
    lowest_free = open("/dev/null", O_RDWR);
  } while (lowest_free >= 0 && lowest_free <= STDERR_FILENO);
  if (lowest_free > STDERR_FILENO) close(lowest_free);
}

/// Raises the number of descriptors that the process may have open to the largest that it may set,
/// for itself and the processes that it starts. Returns that number.
inline rlim_t raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return 0;
  const rlim_t before = std::exchange(limit.rlim_cur, limit.rlim_max);
  return setrlimit(RLIMIT_NOFILE, &limit) == 0 ? limit.rlim_max : before;
}

inline bool is_standard_output(int descriptor, int standard) noexcept {
  struct stat one {
  }, other{};
  return fstat(descriptor, &one) == 0 && fstat(standard, &other) == 0 &&
         one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

/// Opens the target of a link: a device or pipe, as /dev/stdout may be; or the file of the standard
/// output or the standard error, which is continued at its position. Returns −1 and ELOOP for other
/// files.
inline int open_linked_output(const char* path) noexcept {
  const int followed = open(path, O_WRONLY | O_CLOEXEC | O_NONBLOCK);
  if (followed < 0) return -1;
  struct stat status {};
  if (fstat(followed, &status) == 0 && !S_ISREG(status.st_mode)) return followed;
  int found = -1;
  for (const int standard : {STDOUT_FILENO, STDERR_FILENO}) {
    if (found < 0 && is_standard_output(followed, standard)) {
      found = fcntl(standard, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    }
  }
  close(followed);
  if (found < 0) errno = ELOOP;
  return found;
}

/// Opens a file that the user has named for writing, and creates it if it is missing. `flags` are
/// O_TRUNC or O_APPEND, and O_NONBLOCK where writing must not wait either; opening never does. A
/// link to another file is not followed, so that nobody who may write into the folder can have that
/// file overwritten; other links are followed (open_linked_output()). Returns the descriptor, or −1
/// with the reason in errno: ELOOP for such a link, EPIPE for a pipe that nobody reads.
inline int open_output(const char* path, int flags) noexcept {
  int opened = uninterrupted([&] {
    return open(path, O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK | flags, 0666);
  });
  if (opened < 0 && errno == ELOOP) opened = open_linked_output(path);
  struct stat status {};
  if (opened < 0) {
    const int error = errno;
    const bool is_pipe = error == ENXIO && stat(path, &status) == 0 && S_ISFIFO(status.st_mode);
    errno = is_pipe ? EPIPE : error;
    return -1;
  }
  const bool is_own = fstat(opened, &status) == 0 && !S_ISREG(status.st_mode);
  if (is_own && (flags & O_NONBLOCK) == 0) fcntl(opened, F_SETFL, flags & O_APPEND);
  return opened;
}

/// The reason, for messages; `error` is the errno of open_output().
inline std::string output_reason(int error) {
  return error == ELOOP   ? "it is a link, and what it leads to is not overwritten"
         : error == EPIPE ? "it is a pipe that nobody reads; start the reader first"
                          : std::strerror(error);
}

inline bool is_empty_or_begins(const char* path, std::string_view begin) {
  const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return false;
  std::string found(begin.size(), '\0');
  const ssize_t bytes = uninterrupted([&] { return pread(file, found.data(), found.size(), 0); });
  close(file);
  return bytes == 0 || (bytes == static_cast<ssize_t>(begin.size()) && found == begin);
}

/// Works like open_output() with O_NONBLOCK, but empties the file and locks it until it is closed,
/// so that two traces do not overwrite each other. Devices, pipes and the standard output may have
/// several writers, and some network file systems have no locks. A file is emptied only if it
/// begins with `begin`, as all files of the caller do, so that a film is never emptied. Returns −1
/// with the reason in words.
inline int open_own_output(const char* path, std::string_view begin, std::string& reason) {
  const int opened = open_output(path, O_NONBLOCK);
  struct stat status {};
  if (opened < 0) {
    reason = output_reason(errno);
    return -1;
  }
  if (fstat(opened, &status) != 0 || !S_ISREG(status.st_mode)) return opened;
  if (is_standard_output(opened, STDOUT_FILENO) || is_standard_output(opened, STDERR_FILENO)) {
    return opened;
  }
  if (flock(opened, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    reason = "another element or program is writing it; each needs its own file";
  } else if (!is_empty_or_begins(path, begin)) {
    reason = "there is a file with something else in it, which is not replaced; name another file";
  } else if (ftruncate(opened, 0) != 0) {
    reason = std::strerror(errno);
  } else {
    return opened;
  }
  close(opened);
  return -1;
}

/// While this object lives, SIGPIPE does not end the process when the calling thread writes to a
/// closed pipe; the write fails with EPIPE. A library must not change the application's signal
/// handlers, so the signal is blocked for this thread only, and consumed at the end.
class SigpipeBlock {
 public:
  SigpipeBlock() noexcept {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    sigset_t pending;
    sigemptyset(&pending);
    sigpending(&pending);
    was_pending_ = sigismember(&pending, SIGPIPE) == 1;
    pthread_sigmask(SIG_BLOCK, &pipe_, &previous_);
  }
  ~SigpipeBlock() {
    constexpr timespec kNow{0, 0};
    if (!was_pending_) sigtimedwait(&pipe_, nullptr, &kNow);
    pthread_sigmask(SIG_SETMASK, &previous_, nullptr);
  }
  SigpipeBlock(const SigpipeBlock&) = delete;
  SigpipeBlock& operator=(const SigpipeBlock&) = delete;

 private:
  sigset_t pipe_;
  sigset_t previous_;
  bool was_pending_;
};

}  // namespace spidar
