#include "spidar/guardian/guardian.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "spidar/device.h"

extern char** environ;

namespace spidar {
namespace {

std::string program() {
  const char* named = std::getenv("SPIDAR_GUARDIAN");
  return named && *named ? named : SPIDAR_GUARDIAN_PATH;
}

/// Starts the program with `its_end` as its standard input. Returns errno.
int spawn(const std::string& path, int its_end, pid_t& process) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, its_end, STDIN_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A session of its own: Ctrl-C in a terminal is for the host.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  std::string name = "spidar-guardian";
  std::array<char*, 2> arguments{name.data(), nullptr};
  const int error =
      posix_spawn(&process, path.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

}  // namespace

Guardian::Guardian(const std::string& device, const LastWill& will) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
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
  // The answer is 0 when it stands ready, else errno.
  unsigned char answer = 0;
  const bool sent = send(socket_, &will, sizeof will, MSG_NOSIGNAL) == ssize_t{sizeof will};
  if (sent && recv(socket_, &answer, 1, 0) == 1 && answer == 0) return;
  finish(true);
  throw DeviceError(device + ": the guardian " + path + " cannot open " + will.path.data() + ": " +
                    (answer != 0 ? std::strerror(answer) : "it does not answer"));
}

Guardian::~Guardian() {
  finish(true);
}

void Guardian::carry_out() noexcept {
  finish(false);
}

void Guardian::finish(bool dismissed) noexcept {
  if (socket_ < 0) return;
  if (dismissed) send(socket_, &kDismissed, 1, MSG_NOSIGNAL);
  ::close(socket_);
  socket_ = -1;
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace spidar
