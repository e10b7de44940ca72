// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Descriptors that a program opens: the three standard ones, and those of its output, which may
/// be pipes whose reader is gone.
#pragma once

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace spidar {

/// Opens /dev/null for each of the descriptors 0 to 2 that is closed, as after `>&-` in a shell.
/// Otherwise the next file that the program opens gets that number, and what is printed, or what a
/// library writes to the standard error, goes into the file. To be called before anything is
/// opened.
inline void open_standard_descriptors() {
  int lowest_free = 0;
  do {
    lowest_free = open("/dev/null", O_RDWR);
  } while (lowest_free >= 0 && lowest_free <= STDERR_FILENO);
  if (lowest_free > STDERR_FILENO) close(lowest_free);
}

/// Opens a file for writing that the user has named, and makes it if it is not there. `flags` are
/// O_TRUNC or O_APPEND. A link to another file is not followed, so that nobody who may write into
/// the folder can have that file overwritten; one to a device or pipe, as /dev/stdout may be, is.
/// Returns the descriptor, or −1 with the reason in errno, ELOOP for such a link.
inline int open_output(const char* path, int flags) noexcept {
  const int made = open(path, O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC | flags, 0666);
  if (made >= 0 || errno != ELOOP) return made;
  const int followed = open(path, O_WRONLY | O_CLOEXEC);
  struct stat status {};
  if (followed >= 0 && fstat(followed, &status) == 0 && !S_ISREG(status.st_mode)) return followed;
  if (followed >= 0) close(followed);
  errno = ELOOP;
  return -1;
}

/// For messages, `error` as open_output() leaves it in errno.
inline std::string output_reason(int error) {
  return error == ELOOP ? "it is a link, and what it leads to is not overwritten"
                        : std::strerror(error);
}

/// As open_output(), but the file is emptied and locked until it is closed, so that two traces do
/// not overwrite each other. Devices and pipes may have several writers, and some network file
/// systems have no locks. Returns −1 with the reason in words.
inline int open_own_output(const char* path, std::string& reason) {
  const int opened = open_output(path, 0);
  struct stat status {};
  if (opened < 0) {
    reason = output_reason(errno);
    return -1;
  }
  if (fstat(opened, &status) != 0 || !S_ISREG(status.st_mode)) return opened;
  if (flock(opened, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    reason = "another element or program is writing it; each needs its own file";
  } else if (ftruncate(opened, 0) != 0) {
    reason = std::strerror(errno);
  } else {
    return opened;
  }
  close(opened);
  return -1;
}

/// During its lifetime, SIGPIPE does not end the process when the calling thread writes to a closed
/// pipe; the write fails with EPIPE. A library must not change the application's signal handlers,
/// so the signal is blocked for this thread only, and a pending one is consumed at the end.
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
