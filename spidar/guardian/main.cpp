// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Waits until its host dies or stops responding, then sets the motors of one board to zero. The
// class Guardian starts this program with a socket as standard input.
//
// The host passes the device's file, open and claimed. The claim lasts as long as any process has
// that file open. A host that is stopped, or a child that has inherited the file, therefore cannot
// keep the guardian from sending the zeros, and no new host gets the board before it has received
// them.

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <linux/input.h>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "spidar/guardian/guardian.h"
#include "spidar/guardian/sleep_inhibitor.h"
#include "spidar/realtime/standard_descriptors.h"
#include "spidar/realtime/uninterrupted.h"

namespace {

using spidar::GuardianAnswer;
using spidar::HostHeartbeat;
using spidar::LastWill;

constexpr int kRetry_ms = 10;
constexpr int kTransfer_ms = 20;
/// After this time, the effects of an input device have ended by themselves.
constexpr int kInputRetries = spidar::kEffect_ms / kRetry_ms;

/// Whether a file will never accept a packet again, because its device is gone or the file is not a
/// device. Of these errors, the kernel's usbfs returns only ENODEV and ESHUTDOWN; the others come
/// from an emulation that this process does not see.
bool is_gone(int error) {
  return error == ENODEV || error == ESHUTDOWN || error == ENOTTY || error == EBADF;
}

/// Claims the interface unless it is claimed already. A host that has closed the board has released
/// it, perhaps to a driver of the kernel, which this function detaches. Returns 0 or errno.
int claim(const LastWill& will) {
  unsigned interface = will.interface_number;
  if (ioctl(will.file, USBDEVFS_CLAIMINTERFACE, &interface) == 0) return 0;
  if (errno != EBUSY) return errno;
  usbdevfs_disconnect_claim claim{};
  claim.interface = interface;
  claim.flags = USBDEVFS_DISCONNECT_CLAIM_EXCEPT_DRIVER;
  std::memcpy(claim.driver, "usbfs", sizeof "usbfs");
  return ioctl(will.file, USBDEVFS_DISCONNECT_CLAIM, &claim) == 0 ? 0 : errno;
}

/// Returns true when all packets have been sent or can never be sent, or when a new host has
/// claimed the board and set it to zero.
bool send_usb(LastWill& will) {
  const int error = claim(will);
  if (error != 0) return is_gone(error) || error == EBUSY;
  for (uint32_t i = 0; i < will.packets; ++i) {
    usbdevfs_bulktransfer transfer{};
    transfer.ep = will.endpoint;
    transfer.len = will.length[i];
    transfer.timeout = kTransfer_ms;
    transfer.data = will.packet[i].data();
    if (ioctl(will.file, USBDEVFS_BULK, &transfer) >= 0) continue;
    if (is_gone(errno)) return true;
    unsigned endpoint = will.endpoint;
    ioctl(will.file, USBDEVFS_CLEAR_HALT, &endpoint);
    return false;
  }
  return true;
}

bool may_pass(int error) {
  return error == EAGAIN || error == EINTR || error == ENOMEM || error == ENOBUFS;
}

/// A tty returns EIO and others when it was pulled out, a socket EPIPE, ECONNRESET and others when
/// its connection has ended.
bool ends_stream(int error) {
  return !may_pass(error);
}

/// A driver that fails (EIO) may work again.
bool ends_input(int error) {
  return error == ENODEV || error == ENXIO || error == EBADF;
}

/// Works like send_usb() on a non-blocking file.
bool write_all(int file, const uint8_t* bytes, size_t length, bool (*ends)(int error)) {
  for (size_t sent = 0; sent < length;) {
    const ssize_t more = write(file, bytes + sent, length - sent);
    if (more < 0 && ends(errno)) return true;
    if (more < 0 && !may_pass(errno)) return false;
    if (more > 0) sent += static_cast<size_t>(more);
    pollfd writable{file, POLLOUT, 0};
    if (more <= 0 && poll(&writable, 1, kTransfer_ms) == 0) return false;
  }
  return true;
}

bool send_stream(const LastWill& will) {
  for (uint32_t i = 0; i < will.packets; ++i) {
    if (!write_all(will.file, will.packet[i].data(), will.length[i], ends_stream)) return false;
  }
  return true;
}

bool send_event(int file, const LastWill::InputEvent& wanted) {
  input_event event{};
  event.type = EV_FF;
  event.code = static_cast<uint16_t>(wanted.code);
  event.value = wanted.value;
  return write_all(file, reinterpret_cast<const uint8_t*>(&event), sizeof event, ends_input);
}

bool send_input(const LastWill& will) {
  for (uint32_t i = 0; i < will.packets; ++i) {
    LastWill::InputEvent wanted;
    std::memcpy(&wanted, will.packet[i].data(), sizeof wanted);
    if (!send_event(will.file, wanted)) return false;
  }
  return true;
}

bool send_packets(LastWill& will) {
  switch (will.wire) {
    case LastWill::Wire::kUsb:
      return send_usb(will);
    case LastWill::Wire::kTerminal:
    case LastWill::Wire::kSocket:
      return send_stream(will);
    case LastWill::Wire::kInput:
      return send_input(will);
  }
  return true;  // receive() has refused every other type
}

void sleep_ms(int milliseconds) {
  const timespec duration{0, milliseconds * 1'000'000};
  nanosleep(&duration, nullptr);
}

/// Returns true when the zeros have arrived or the device is gone. A board may recover at any time,
/// and pulls until then. The effects of an input device end by themselves, and the kernel erases
/// them when no process has the file open, so ending is better than retrying forever.
bool carry_out(LastWill& will) {
  for (int retries = 0; !send_packets(will); ++retries) {
    if (will.wire == LastWill::Wire::kInput && retries == kInputRetries) return false;
    sleep_ms(kRetry_ms);
  }
  return true;
}

/// Call this at rest: more gain would make a force stronger. There is only one attempt.
void return_settings(const LastWill& will) {
  for (uint32_t i = 0; i < will.settings; ++i) {
    if (!send_event(will.file, will.setting[i])) return;
    sleep_ms(spidar::kSetting_ms);
  }
}

/// Receives the will, with a descriptor of this process for the device's file, and one for the
/// host. Returns false when the message is not from a host of this version.
bool receive(LastWill& will, int& host) {
  std::array<int, 2> files{-1, -1};
  iovec bytes{&will, sizeof will};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof files)> space{};
  msghdr message{};
  message.msg_iov = &bytes;
  message.msg_iovlen = 1;
  message.msg_control = space.data();
  message.msg_controllen = space.size();
  const ssize_t got =
      spidar::uninterrupted([&] { return recvmsg(STDIN_FILENO, &message, MSG_CMSG_CLOEXEC); });
  if (got != ssize_t{sizeof will}) return false;
  const cmsghdr* rights = CMSG_FIRSTHDR(&message);
  if (!rights || rights->cmsg_type != SCM_RIGHTS || rights->cmsg_len != CMSG_LEN(sizeof files)) {
    return false;
  }
  std::memcpy(files.data(), CMSG_DATA(rights), sizeof files);
  will.file = files[0];
  host = files[1];
  if (will.magic != LastWill::kMagic || will.packets > LastWill::kMaxPackets ||
      will.settings > LastWill::kMaxSettings || will.wire > LastWill::Wire::kSocket) {
    return false;
  }
  for (uint32_t i = 0; i < will.packets; ++i) {
    if (will.length[i] > LastWill::kMaxLength) return false;
  }
  return true;
}

bool answer_host(GuardianAnswer answer) {
  return send(STDIN_FILENO, &answer, 1, MSG_DONTWAIT | MSG_NOSIGNAL) == 1;
}

/// Sends the zeros whenever the host is silent while its motors pull. Returns true when the host
/// has ended, and false when it has dismissed its guardian. `pulled`: whether motors pulled.
bool watch(int host, LastWill& will, bool& pulled) {
  bool pulling = false, zeroed = false, failed = false;
  spidar::SleepInhibitor inhibitor;
  for (;;) {
    std::array<pollfd, 2> events{pollfd{STDIN_FILENO, POLLIN, 0}, pollfd{host, POLLIN, 0}};
    const int wait_ms = failed ? kRetry_ms : pulling || zeroed ? spidar::kSilence_ms : -1;
    const int ready =
        spidar::uninterrupted([&] { return poll(events.data(), events.size(), wait_ms); });
    if (ready < 0) return true;
    if (ready == 0) {
      // Sends once only, so that a host that continues gets its answers while the board fails.
      failed = !send_packets(will);
      zeroed = true;
    } else if (events[0].revents == 0) {
      // A last message may be waiting: a host that dismissed its guardian may have ended since.
      return true;
    } else {
      HostHeartbeat heartbeat{};
      if (recv(STDIN_FILENO, &heartbeat, 1, 0) != 1) return true;
      if (heartbeat == HostHeartbeat::kDismissed) return false;
      pulling = heartbeat == HostHeartbeat::kPulling;
      pulled |= pulling;
      inhibitor.inhibit(pulling);
    }
    answer_host(zeroed ? GuardianAnswer::kZeroed : GuardianAnswer::kWatching);
  }
}

/// The guardian must act in time even when the machine is busy or short of memory. If a privilege
/// is missing, the guardian does without it. Its children have the usual priority.
void set_realtime_priority() {
  sched_param parameters{};
  parameters.sched_priority = sched_get_priority_min(SCHED_FIFO);
  sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters);
  mlockall(MCL_CURRENT | MCL_FUTURE);
}

}  // namespace

int main() {
  spidar::open_standard_descriptors();
  prctl(PR_SET_NAME, "spidar-guardian");
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT, SIGTSTP}) {
    signal(number, SIG_IGN);
  }
  // Other inherited files would stay open as long as this process runs.
  close_range(STDERR_FILENO + 1, ~0U, 0);
  LastWill will;
  int host = -1;
  if (!receive(will, host)) {
    std::fputs("spidar-guardian: started by gst-spidar, not by hand\n", stderr);
    return 2;
  }
  if (chdir("/") != 0) return 1;
  set_realtime_priority();
  if (!answer_host(GuardianAnswer::kWatching)) return 1;
  bool pulled = false;
  if (watch(host, will, pulled) && carry_out(will) && pulled) return_settings(will);
  return 0;
}
