// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/emulated_bus/claim_locks.h"

#include <fcntl.h>
#include <string>
#include <sys/syscall.h>
#include <unistd.h>

#include "tests/emulated_bus/usb_files.h"

namespace spidar::test {
namespace {

int& lock_file() {
  static int file = -1;
  return file;
}

/// 0 when it locks or unlocks the board.
int set_lock(int file, int address, short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = address;
  lock.l_len = 1;
  return fcntl(file, F_OFD_SETLK, &lock);
}

}  // namespace

void set_lock_file(int file) {
  lock_file() = file;
}

bool lock_board(int address, int& lock) {
  lock = -1;
  if (lock_file() < 0) return true;
  // A separate lock, because a lock shared by copies of a descriptor ends with the last of them.
  const std::string path = "/proc/self/fd/" + std::to_string(lock_file());
  const int own = real_open(path.c_str(), O_RDWR | O_CLOEXEC, 0);
  if (own < 0 || set_lock(own, address, F_WRLCK) != 0) {
    syscall(SYS_close, own);
    return false;
  }
  lock = own;
  return true;
}

void unlock_board(int address, int& lock) {
  if (lock < 0) return;
  set_lock(lock, address, F_UNLCK);
  syscall(SYS_close, lock);
  lock = -1;
}

}  // namespace spidar::test
