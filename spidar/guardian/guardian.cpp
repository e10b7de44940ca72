// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/guardian/guardian.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

#include "spidar/child_process.h"
#include "spidar/device.h"
#include "spidar/folders.h"
#include "spidar/guardian/sleep_inhibitor.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/uninterrupted.h"

namespace spidar {
namespace {

/// A guardian answers as soon as it runs. Making a scope takes some tens of milliseconds.
constexpr int kAnswerTimeout_s = 5;
constexpr int kScopeTimeout_s = 2;

std::string program() {
  const char* named = secure_getenv("SPIDAR_GUARDIAN");
  return named && *named ? named : installed(SPIDAR_GUARDIAN_PATH).string();
}

bool is_socket(const std::string& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 && S_ISSOCK(status.st_mode);
}

/// The command that makes a transient scope and then replaces itself by the guardian, whose process
/// id and files are therefore those of the command. Empty without systemd.
std::vector<std::string> in_a_scope(const std::string& path) {
  const std::string run = systemd_program("systemd-run");
  if (run.empty()) return {};
  std::vector<std::string> command{run, "--scope", "--quiet", "--collect",
                                   "--description=Guardian of a haptic device"};
  if (geteuid() != 0) command.emplace_back("--user");
  command.insert(command.end(), {"--", path});
  return command;
}

int64_t seconds_from_now_ns(int seconds) {
  return monotonic_now_ns() + seconds * kSecond_ns;
}

void set_socket_timeout(int socket, int seconds) {
  const timeval patience{seconds, 0};
  setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
}

/// Sends the will, the device's file, and a descriptor that shows the end of this process.
bool send_last_will(int socket, const LastWill& will, int64_t until_ns) {
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
  const bool all = uninterrupted_until(until_ns, [&] {
                     return sendmsg(socket, &message, MSG_NOSIGNAL);
                   }) == ssize_t{sizeof sent};
  const int error = errno;
  ::close(self);
  errno = error;
  return all;
}

}  // namespace

Guardian::Guardian(const std::string& device, const LastWill& will) : owner_(getpid()) {
  const std::string path = program();
  const bool service = is_socket(path);
  const std::vector<std::string> scoped = in_a_scope(path);
  if (!service && !scoped.empty() && start(scoped, will, kScopeTimeout_s)) return;
  errno = 0;
  const bool works = service ? connect_to(path) && greet(will, kAnswerTimeout_s)
                             : start({path}, will, kAnswerTimeout_s);
  if (works) return;
  const std::string why =
      errno != 0 ? std::strerror(errno) : "does not answer, it may be of another version";
  if (socket_ >= 0) ::close(socket_);
  throw DeviceError(device + ": no guardian to zero the motors should this process be killed: " +
                    path + ": " + why + "; install spidar-guardian, or name it in SPIDAR_GUARDIAN");
}

/// Returns false, and sets errno where there is a reason, when the guardian does not work.
bool Guardian::start(const std::vector<std::string>& command, const LastWill& will, int timeout_s) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return false;
  socket_ = ends[0];
  std::vector<std::pair<int, int>> files{{ends[1], STDIN_FILENO}};
  // Hides an error of systemd-run, after which the guardian is started without systemd-run.
  if (command.size() > 1) files.emplace_back(kDevNull, STDERR_FILENO);
  // In a session of its own, Ctrl-C in a terminal reaches only the host.
  process_ = start_child(command[0], command, files, POSIX_SPAWN_SETSID);
  const int error = errno;
  ::close(ends[1]);
  if (process_ > 0) return greet(will, timeout_s);
  ::close(socket_);
  socket_ = -1;
  errno = error;
  return false;
}

bool Guardian::connect_to(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return false;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  socket_ = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (socket_ < 0) return false;
  set_socket_timeout(socket_, kAnswerTimeout_s);  // a service that accepts nobody has a full queue
  return uninterrupted_until(seconds_from_now_ns(kAnswerTimeout_s), [&] {
           return connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address);
         }) == 0;
}

/// Gives the guardian its will and waits for its answer.
bool Guardian::greet(const LastWill& will, int timeout_s) {
  set_socket_timeout(socket_, timeout_s);
  const int64_t until_ns = seconds_from_now_ns(timeout_s);
  char answer = 0;
  errno = 0;
  const auto is_answered = [&] {
    return uninterrupted_until(until_ns, [&] { return recv(socket_, &answer, 1, 0); }) == 1;
  };
  if (send_last_will(socket_, will, until_ns) && is_answered()) return true;
  // The started program did not receive the will, or does not answer.
  const int error =
      errno == EAGAIN || errno == EINTR || errno == EPIPE || errno == ECONNRESET ? 0 : errno;
  send_signal(SIGKILL);
  finish(End::kWait);
  errno = error;
  return false;
}

Guardian::~Guardian() {
  if (socket_ >= 0 && getpid() == owner_) send_heartbeat(HostHeartbeat::kDismissed);
  finish(End::kWait);
}

void Guardian::carry_out() noexcept {
  finish(End::kLeave);
}

bool Guardian::send_heartbeat(HostHeartbeat heartbeat) noexcept {
  const ssize_t sent = send(socket_, &heartbeat, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
  // If the socket is full, the guardian is stopped; watch() notices that by the missing answers.
  return sent == 1 || errno == EAGAIN;
}

bool Guardian::watch(bool pulling) noexcept {
  if (socket_ < 0 || getpid() != owner_) return false;
  constexpr int64_t kMillisecond_ns = kSecond_ns / 1000, kBeat_ns = kBeat_ms * kMillisecond_ns;
  const int64_t now_ns = monotonic_now_ns();
  int64_t passed_ns = now_ns - std::exchange(watched_ns_, now_ns);
  was_suspended_ |= pulling_ && passed_ns > kSilence_ms * kMillisecond_ns;
  // At rest nothing is at stake, and whatever has suspended this process, such as a virtual machine
  // without a processor, may have suspended the guardian as well: a pause counts as kBeat_ms.
  if (!pulling_) passed_ns = std::min(passed_ns, kBeat_ns);
  silent_ns_ += passed_ns;
  GuardianAnswer answer{};
  ssize_t got = 0;
  while ((got = recv(socket_, &answer, 1, MSG_DONTWAIT)) > 0) {
    was_suspended_ |= answer == GuardianAnswer::kZeroed;
    silent_ns_ = passed_ns;  // the answer came after the last call, at some time
  }
  if (was_suspended_ || got == 0 || errno != EAGAIN) return false;
  if (silent_ns_ > kAnswer_ms * kMillisecond_ns) return false;
  if (pulling == pulling_ && now_ns - sent_ns_ < kBeat_ns) return true;
  pulling_ = pulling;
  sent_ns_ = now_ns;
  return send_heartbeat(pulling ? HostHeartbeat::kPulling : HostHeartbeat::kResting);
}

void Guardian::send_signal(int number) const noexcept {
  if (process_ > 0) kill(process_, number);
}

/// Ends the connection and waits until the guardian has ended.
void Guardian::finish(End end) noexcept {
  if (socket_ < 0) return;
  // A forked child only closes its copy of the socket.
  if (getpid() == owner_) {
    send_signal(SIGCONT);  // it may have been stopped
    set_socket_timeout(socket_, kEnd_s);
    // close() would not suffice, because a forked child may hold the socket, too.
    shutdown(socket_, SHUT_WR);
    char answer = 0;
    ssize_t got = 0;
    const int64_t until_ns = seconds_from_now_ns(kEnd_s);
    do {
      got = uninterrupted_until(until_ns, [&] { return recv(socket_, &answer, 1, 0); });
    } while (got > 0);
    // Its end of the socket is still open, so its process id has not been reused.
    const bool open = got < 0 && (errno == EAGAIN || errno == EINTR);
    if (open && end == End::kWait) send_signal(SIGKILL);
    const bool leave = open && end == End::kLeave;
    if (process_ > 0 && !leave) uninterrupted([&] { return waitpid(process_, nullptr, 0); });
  }
  ::close(socket_);
  socket_ = -1;
}

}  // namespace spidar
