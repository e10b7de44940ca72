// Waits for its host to die, then takes the motors of one board to zero. Started by Guardian with a
// socket as standard input.
//
// The kernel closes a dead process' files in no promised order and releases the board while it does
// so: claiming is tried for a second. When a new host is faster, it has zeroed the motors itself.

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "spidar/guardian/last_will.h"

namespace {

using spidar::LastWill;

constexpr int kTries = 100;
constexpr unsigned kTransfer_ms = 20;

void pause_10ms() {
  const timespec duration{0, 10'000'000};
  nanosleep(&duration, nullptr);
}

/// True when all packets are sent, or never can be.
bool send_usb(int file, LastWill& will) {
  unsigned interface = will.interface_number;
  if (ioctl(file, USBDEVFS_CLAIMINTERFACE, &interface) != 0) return errno == ENODEV;
  for (uint32_t i = 0; i < will.packets; ++i) {
    usbdevfs_bulktransfer transfer{};
    transfer.ep = will.endpoint;
    transfer.len = will.length[i];
    transfer.timeout = kTransfer_ms;
    transfer.data = will.packet[i].data();
    if (ioctl(file, USBDEVFS_BULK, &transfer) >= 0) continue;
    if (errno == ENODEV || errno == ESHUTDOWN) return true;
    unsigned endpoint = will.endpoint;
    ioctl(file, USBDEVFS_CLEAR_HALT, &endpoint);
    return false;
  }
  return true;
}

bool send_terminal(int file, const LastWill& will) {
  if (flock(file, LOCK_EX | LOCK_NB) != 0) return false;
  for (uint32_t i = 0; i < will.packets; ++i) {
    if (write(file, will.packet[i].data(), will.length[i]) != ssize_t{will.length[i]})
      return errno == EIO || errno == ENXIO;
  }
  return true;
}

bool valid(const LastWill& will) {
  bool lengths = will.packets <= LastWill::kMaxPackets;
  for (uint32_t i = 0; lengths && i < will.packets; ++i)
    lengths = will.length[i] <= LastWill::kMaxLength;
  return lengths && will.magic == LastWill::kMagic && will.path.back() == '\0';
}

}  // namespace

int main() {
  prctl(PR_SET_NAME, "spidar-guardian");
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT}) signal(number, SIG_IGN);
  LastWill will;
  if (recv(STDIN_FILENO, &will, sizeof will, MSG_WAITALL) != ssize_t{sizeof will} || !valid(will)) {
    std::fputs("spidar-guardian: started by gst-spidar, not by hand\n", stderr);
    return 2;
  }
  // What else the host had open would otherwise stay open as long as this does.
  close_range(STDERR_FILENO + 1, ~0U, 0);
  if (chdir("/") != 0) return 1;
  const bool usb = will.wire == LastWill::Wire::kUsb;
  const int file = open(will.path.data(), (usb ? O_RDWR : O_WRONLY) | O_NOCTTY | O_CLOEXEC);
  const auto answer = static_cast<unsigned char>(file < 0 ? errno : 0);
  if (send(STDIN_FILENO, &answer, 1, MSG_NOSIGNAL) != 1 || file < 0) return 1;

  char word = 0;
  ssize_t got = 0;
  do {
    got = read(STDIN_FILENO, &word, 1);
  } while (got < 0 && errno == EINTR);
  if (got == 1 && word == spidar::kDismissed) return 0;
  for (int i = 0; i < kTries; ++i) {
    if (usb ? send_usb(file, will) : send_terminal(file, will)) return 0;
    pause_10ms();
  }
  return 1;
}
