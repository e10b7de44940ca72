// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "plugin/feel/video_notice.h"

#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <mutex>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

namespace spidar {
namespace {

/// Number and inode of the socket: a process that closes the files it inherits may open another one
/// under this number.
constexpr const char* kVariable = "SPIDAR_FEEL_NOTICE";

unsigned long long inode(int file) noexcept {
  struct stat status;
  return fstat(file, &status) == 0 && S_ISSOCK(status.st_mode) ? status.st_ino : 0;
}

/// Only system calls that may be made between fork() and exec().
[[noreturn]] void wait_for_notice(int socket, const std::string& message) {
  const int nothing = open("/dev/null", O_RDWR);
  dup2(nothing, STDIN_FILENO);
  dup2(nothing, STDOUT_FILENO);
  (void)!chdir("/");
  pollfd news{socket, POLLIN, 0};
  char noticed = 0;
  const bool video = poll(&news, 1, 1000 * kPatience_s) > 0 && read(socket, &noticed, 1) > 0;
  if (!video) (void)!write(STDERR_FILENO, message.data(), message.size());
  _exit(0);
}

}  // namespace

void expect_video(const std::string& program) {
  int ends[2];
  if (std::getenv(kVariable) || socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return;
  const std::string message =
      "spidar-feel: " + program +
      " has shown no video by GStreamer, so nothing of it is felt. mpv, VLC, Kodi, Firefox and "
      "Chromium do not use GStreamer: play the film with gst-play-1.0, Totem, Parole, Clapper or "
      "Showtime. If it has been handed to a window that was open before, close that window "
      "first.\n";
  // The player must not find a child that it did not start: the process that waits is a grandchild,
  // and init adopts it.
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    if (fork() == 0) wait_for_notice(ends[1], message);
    _exit(0);
  }
  if (child > 0) waitpid(child, nullptr, 0);
  close(ends[1]);
  char value[64];
  std::snprintf(value, sizeof value, "%d %llu", ends[0], inode(ends[0]));
  setenv(kVariable, value, 1);
}

void notice_video() noexcept {
  static std::once_flag once;
  std::call_once(once, [] {
    const char* value = std::getenv(kVariable);
    int file = -1;
    unsigned long long expected = 0;
    if (!value || std::sscanf(value, "%d %llu", &file, &expected) != 2) return;
    if (expected == 0 || inode(file) != expected) return;
    send(file, "", 1, MSG_NOSIGNAL | MSG_DONTWAIT);
    close(file);
  });
}

}  // namespace spidar
