// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/guardian/guardian.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "spidar/device.h"
#include "spidar/install_folder.h"
#include "spidar/realtime/monotonic.h"

extern char** environ;

namespace spidar {
namespace {

/// How long to wait for an answer: carrying out a will takes at most two seconds.
constexpr time_t kPatience_s = 5;

std::string program() {
  const char* named = std::getenv("SPIDAR_GUARDIAN");
  return named && *named ? named : installed(SPIDAR_GUARDIAN_PATH).string();
}

/// Starts the program with `its_end` as its standard input. Returns errno.
int spawn(const std::string& path, int its_end, pid_t& process) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, its_end, STDIN_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // In a session of its own, so that Ctrl-C in a terminal reaches only the host.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  std::string name = "spidar-guardian";
  std::array<char*, 2> arguments{name.data(), nullptr};
  const int error =
      posix_spawn(&process, path.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

/// The will, the device's file, and a descriptor by which the end of this process is noticed.
bool send_will(int socket, const LastWill& will) {
  const int self = static_cast<int>(syscall(SYS_pidfd_open, getpid(), 0));
  if (self < 0) return false;
  const std::array<int, 2> files{will.file, self};
  LastWill sent = will;
  iovec bytes{&sent, sizeof sent};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof files)> space{};
  msghdr message{};
  message.msg_iov = &bytes;
  message.msg_iovlen = 1;
  message.msg_control = space.data();
  message.msg_controllen = space.size();
  cmsghdr* rights = CMSG_FIRSTHDR(&message);
  rights->cmsg_level = SOL_SOCKET;
  rights->cmsg_type = SCM_RIGHTS;
  rights->cmsg_len = CMSG_LEN(sizeof files);
  std::memcpy(CMSG_DATA(rights), files.data(), sizeof files);
  const bool all = sendmsg(socket, &message, MSG_NOSIGNAL) == ssize_t{sizeof sent};
  const int error = errno;
  ::close(self);
  errno = error;
  return all;
}

}  // namespace

Guardian::Guardian(const std::string& device, const LastWill& will) : owner_(getpid()) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw DeviceError(device + ": no guardian: " + std::strerror(errno));
  const std::string path = program();
  const int error = spawn(path, ends[1], process_);
  ::close(ends[1]);
  socket_ = ends[0];
  if (error != 0) {
    ::close(socket_);
    throw DeviceError(
        device + ": no guardian to zero the motors should this process be killed: " + path + ": " +
        std::strerror(error) + "; install spidar-guardian, or name it in SPIDAR_GUARDIAN");
  }
  const timeval patience{kPatience_s, 0};
  setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  char answer = 0;
  if (!send_will(socket_, will)) {
    const std::string why = std::strerror(errno);
    finish();
    throw DeviceError(device + ": the guardian " + path + " cannot be told of the board: " + why);
  }
  if (recv(socket_, &answer, 1, 0) == 1) return;
  finish();
  throw DeviceError(device + ": the guardian " + path +
                    " does not answer; is it of the same version as this library?");
}

Guardian::~Guardian() {
  if (socket_ >= 0 && getpid() == owner_) say(HostWord::kDismissed);
  finish();
}

void Guardian::carry_out() noexcept {
  finish();
}

bool Guardian::say(HostWord word) noexcept {
  const ssize_t sent = send(socket_, &word, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
  // A full socket belongs to a guardian that sleeps; missing answers reveal that.
  return sent == 1 || errno == EAGAIN || errno == EINTR;
}

bool Guardian::watch(bool pulling) noexcept {
  if (socket_ < 0 || getpid() != owner_) return false;
  GuardianWord answer{};
  ssize_t got = 0;
  while ((got = recv(socket_, &answer, 1, MSG_DONTWAIT)) > 0) {
    zeroed_ |= answer == GuardianWord::kZeroed;
    unanswered_ns_ = 0;
  }
  if (zeroed_ || got == 0 || (errno != EAGAIN && errno != EINTR)) return false;
  const int64_t now_ns = monotonic_now_ns();
  if (unanswered_ns_ != 0 && now_ns - unanswered_ns_ > kAnswer_ns) {
    kill(process_, SIGKILL);
    return false;
  }
  const bool due = pulling && now_ns - said_ns_ >= kBeat_ms * kSecond_ns / 1000;
  if (pulling == pulling_ && !due) return true;
  pulling_ = pulling;
  said_ns_ = now_ns;
  if (unanswered_ns_ == 0) unanswered_ns_ = now_ns;
  return say(pulling ? HostWord::kPulling : HostWord::kResting);
}

/// Waits until the guardian has ended.
void Guardian::finish() noexcept {
  if (socket_ < 0) return;
  // A forked child only closes its copy of the socket.
  if (getpid() == owner_) {
    // Not close(), because a forked child may hold the socket, too.
    shutdown(socket_, SHUT_WR);
    char answer = 0;
    ssize_t got = 0;
    do {
      got = recv(socket_, &answer, 1, 0);
    } while (got > 0 || (got < 0 && errno == EINTR));
    // The guardian is stopped. Its end of the socket is still open, so its process id has not been
    // reused.
    if (got < 0 && errno == EAGAIN) kill(process_, SIGKILL);
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  ::close(socket_);
  socket_ = -1;
}

}  // namespace spidar
