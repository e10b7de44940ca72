// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The parts of usbfs that the Linux backend of libusb 1.0 uses.
//
// Readiness: the file is one end of a socket pair. Its send buffer is kept full while there is
// nothing to reap, so that poll(POLLOUT) waits. Closing the other end with unread data causes
// POLLERR, as when a device is pulled out.
#include "tests/emulated_bus/usb_files.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <deque>
#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <memory>
#include <mutex>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "spidar/link/device_kind.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/emulated_bus/claim_locks.h"

namespace spidar::test {
namespace {

constexpr uint8_t kIn = 0x80;

/// Motors and encoders of a port.
class PortMotors final : public emulated::Motors {
 public:
  explicit PortMotors(UsbPort& port) : port_(port) {}
  void set_outputs(const std::array<int, kMaxStrings>& digits) noexcept override {
    for (size_t i = 0; i < digits.size(); ++i) port_.digit[i] = digits[i];
    ++port_.updates;
  }
  std::array<int32_t, kMaxStrings> counts() noexcept override {
    std::array<int32_t, kMaxStrings> counts{};
    for (size_t i = 0; i < counts.size(); ++i) counts[i] = port_.count[i];
    return counts;
  }
  uint16_t inputs() noexcept override { return port_.inputs; }

 private:
  UsbPort& port_;
};

/// The negative errno with which usbfs ends a transfer on such a link; 0: the transfer succeeds.
int status_of(LinkFault fault) {
  switch (fault) {
    case LinkFault::kStall:
      return -EPIPE;
    case LinkFault::kBusError:
      return -EPROTO;
    default:
      return 0;
  }
}

/// Changes a reply as the fault does. Returns how many bytes of it arrive.
size_t spoil_reply(LinkFault fault, MutableBytes reply) {
  if (fault == LinkFault::kWrongReply)
    for (size_t i = 0; i < reply.size; ++i) reply.data[i] ^= 0xA5;
  if (fault == LinkFault::kWrongEcho) reply.data[0] ^= 0x10;
  return fault == LinkFault::kShort ? reply.size / 2 : reply.size;
}

/// Null when it was pulled out meanwhile.
std::unique_ptr<emulated::Board> board_in(UsbPort& port) {
  const DeviceKind* const kind = kind_in(port);
  if (!kind) return nullptr;
  auto board = kind->emulate(std::make_shared<PortMotors>(port));
  board->remember(port.memory);
  return board;
}

struct UsbFile {
  explicit UsbFile(SharedFile& with)
      : shared(with),
        port_number(shared.port),
        port(bus().port[port_number]),
        board(board_in(port)) {}

  SharedFile& shared;
  const size_t port_number;
  UsbPort& port;
  std::unique_ptr<emulated::Board> board;
  int file = -1;
  int other_end = -1;  // −1: held by another process
  int claim_lock = -1;
  bool full = false;
  bool connected = true;
  std::deque<usbdevfs_urb*> waiting;  // IN transfers that wait for a reply of the board
  std::deque<usbdevfs_urb*> done;
};

std::mutex& mutex() {
  static auto* const it = new std::mutex;
  return *it;
}

constexpr size_t kMaxFiles = 4096;

std::array<std::atomic<UsbFile*>, kMaxFiles>& files() {
  static auto* const it = new std::array<std::atomic<UsbFile*>, kMaxFiles>{};
  return *it;
}

UsbFile* find(int file) {
  return file >= 0 && file < static_cast<int>(kMaxFiles) ? files()[static_cast<size_t>(file)].load()
                                                         : nullptr;
}

/// 0 when it is not a socket.
uint64_t inode_of(int file) {
  struct stat status {};
  return fstat(file, &status) == 0 && S_ISSOCK(status.st_mode) ? status.st_ino : 0;
}

/// Room for one more file of the bus, replacing the oldest.
SharedFile& fraction(int file, size_t port) {
  SharedFile& shared = bus().file[bus().files_opened++ % kSharedFiles];
  shared.claimed = false;
  shared.port = port;
  shared.address = bus().port[port].address.load();
  shared.inode = inode_of(file);
  return shared;
}

/// A file that another process has opened and passed to this one.
UsbFile* adopt(int file) {
  const uint64_t inode = file >= 0 && file < static_cast<int>(kMaxFiles) ? inode_of(file) : 0;
  if (inode == 0) return nullptr;
  for (SharedFile& shared : bus().file) {
    if (shared.inode != inode) continue;
    auto* f = new UsbFile(shared);
    f->file = file;
    files()[static_cast<size_t>(file)] = f;
    return f;
  }
  return nullptr;
}

void make_ready(UsbFile& f) {
  std::array<char, 4096> bytes;
  if (f.full) recv(f.other_end, bytes.data(), bytes.size(), MSG_DONTWAIT);
  f.full = false;
}

void make_unready(UsbFile& f) {
  // More than a quarter of the smallest send buffer, from where on it counts as not writable.
  const std::array<char, 2048> bytes{};
  if (!f.full) send(f.file, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  f.full = true;
}

void finish(UsbFile& f, usbdevfs_urb* urb, int status, size_t length) {
  urb->status = status;
  urb->actual_length = static_cast<int>(length);
  f.done.push_back(urb);
  make_ready(f);
}

void disconnect(UsbFile& f, int errno_first) {
  if (!f.connected) return;
  f.connected = false;
  for (usbdevfs_urb* urb : f.waiting) finish(f, urb, errno_first ? -errno_first : -ESHUTDOWN, 0);
  f.waiting.clear();
  if (f.other_end < 0) return;
  make_unready(f);
  syscall(SYS_close, f.other_end);
}

bool still_there(UsbFile& f) {
  if (f.port.kind == 0 || f.port.address != f.shared.address) disconnect(f, 0);
  return f.connected;
}

/// Puts the board's replies into the waiting URBs, with the fault that is set for the port.
void answer(UsbFile& f) {
  while (!f.waiting.empty()) {
    const LinkFault fault = f.port.fault;
    if (fault == LinkFault::kTimeout) return;
    usbdevfs_urb* urb = f.waiting.front();
    auto* bytes = static_cast<uint8_t*>(urb->buffer);
    size_t length = f.board->reply({bytes, static_cast<size_t>(urb->buffer_length)});
    if (length == 0) return;
    length = spoil_reply(fault, {bytes, length});
    f.waiting.pop_front();
    finish(f, urb, fault == LinkFault::kBabble ? -EOVERFLOW : 0, length);
  }
}

/// Requests of the vendor that have no data; the buffer begins with the setup packet.
bool control(UsbFile& f, const usbdevfs_urb& urb) {
  const ByteView setup(static_cast<const uint8_t*>(urb.buffer), 8);
  if (setup.u8(0) != ftdi::kRequestType || setup.u16(6) != 0) return false;
  return f.board->control({setup.u8(1), setup.u16(2)});
}

int submit(UsbFile& f, usbdevfs_urb* urb) {
  if (!f.shared.claimed && urb->type != USBDEVFS_URB_TYPE_CONTROL) return -ENOENT;
  if (const int status = status_of(f.port.fault)) {
    finish(f, urb, status, 0);
  } else if (urb->type == USBDEVFS_URB_TYPE_CONTROL) {
    finish(f, urb, control(f, *urb) ? 0 : -EPIPE, 0);
  } else if (urb->endpoint & kIn) {
    f.waiting.push_back(urb);
    answer(f);
  } else {
    const auto length = static_cast<size_t>(urb->buffer_length);
    f.board->receive({static_cast<const uint8_t*>(urb->buffer), length});
    finish(f, urb, 0, length);
    answer(f);
  }
  return 0;
}

int reap(UsbFile& f, void** urb) {
  if (f.done.empty()) return f.connected ? -EAGAIN : -ENODEV;
  *urb = f.done.front();
  f.done.pop_front();
  if (f.done.empty() && f.connected) make_unready(f);
  return 0;
}

int discard(UsbFile& f, void* urb) {
  const auto at = std::find(f.waiting.begin(), f.waiting.end(), urb);
  if (at == f.waiting.end()) return -EINVAL;
  finish(f, *at, -ENOENT, 0);
  f.waiting.erase(at);
  return 0;
}

/// The synchronous transfer, which libusb never uses but spidar-guardian does.
int bulk(UsbFile& f, usbdevfs_bulktransfer& transfer) {
  if (!f.shared.claimed) return -ENOENT;
  if (const int status = status_of(f.port.fault)) return status;
  if (transfer.ep & kIn) return -ETIMEDOUT;
  f.board->receive({static_cast<const uint8_t*>(transfer.data), transfer.len});
  return static_cast<int>(transfer.len);
}

/// Excludes other processes by a lock, and this one by a check. A file that is passed on is claimed
/// already. After the death of its first owner others could claim it as well, which usbfs would not
/// allow.
int claim(UsbFile& f, bool detach) {
  if (f.shared.claimed) return 0;
  if (f.port.has_driver && !detach) return -EBUSY;
  f.port.has_driver = false;
  for (const auto& entry : files()) {
    const UsbFile* other = entry.load();
    if (other && other != &f && other->shared.address == f.shared.address && other->shared.claimed)
      return -EBUSY;
  }
  if (!lock_board(f.shared.address, f.claim_lock)) return -EBUSY;
  f.shared.claimed = true;
  return 0;
}

int release(UsbFile& f) {
  f.shared.claimed = false;
  unlock_board(f.shared.address, f.claim_lock);
  return 0;
}

int handle(UsbFile& f, unsigned long request, void* argument) {
  const bool there = still_there(f);
  if (request == USBDEVFS_REAPURBNDELAY) return reap(f, static_cast<void**>(argument));
  if (request == USBDEVFS_DISCARDURB) return discard(f, argument);
  if (!there) return -ENODEV;
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES:
      *static_cast<uint32_t*>(argument) =
          USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
          USBDEVFS_CAP_BULK_SCATTER_GATHER | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
      return 0;
    case USBDEVFS_SUBMITURB:
      return submit(f, static_cast<usbdevfs_urb*>(argument));
    case USBDEVFS_BULK:
      return bulk(f, *static_cast<usbdevfs_bulktransfer*>(argument));
    case USBDEVFS_CLAIMINTERFACE:
      return claim(f, false);
    case USBDEVFS_DISCONNECT_CLAIM:
      return claim(f, true);
    case USBDEVFS_RELEASEINTERFACE:
      return release(f);
    case USBDEVFS_CLEAR_HALT:
      ++f.port.halts_cleared;
      return 0;
    case USBDEVFS_SETINTERFACE:
    case USBDEVFS_RESET:
      return 0;
    default:  // USBDEVFS_IOCTL asks for the kernel driver back: there is none
      return -ENODATA;
  }
}

}  // namespace

int real_open(const char* path, int flags, unsigned mode) {
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

int open_usb_file(size_t port) {
  if (bus().port[port].forbidden) {
    errno = EACCES;
    return -1;
  }
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return -1;
  const int smallest = 1;
  setsockopt(ends[0], SOL_SOCKET, SO_SNDBUF, &smallest, sizeof smallest);
  const std::lock_guard<std::mutex> lock(mutex());
  auto* f = new UsbFile(fraction(ends[0], port));
  f->file = ends[0];
  f->other_end = ends[1];
  make_unready(*f);
  files()[static_cast<size_t>(ends[0])] = f;
  return ends[0];
}

bool usb_ioctl(int file, unsigned long request, void* argument, int& result) {
  // 'U' marks requests of usbfs; others are far more frequent.
  if (_IOC_TYPE(request) != 'U') return false;
  const std::lock_guard<std::mutex> lock(mutex());
  UsbFile* f = find(file);
  if (!f) f = adopt(file);
  if (!f) return false;
  result = handle(*f, request, argument);
  if (result < 0) {
    errno = -result;
    result = -1;
  }
  return true;
}

void forget_usb_file(int file) {
  if (!find(file)) return;
  const std::lock_guard<std::mutex> lock(mutex());
  UsbFile* f = find(file);
  if (!f) return;
  files()[static_cast<size_t>(file)] = nullptr;
  if (f->other_end >= 0) {
    release(*f);
    if (f->connected) syscall(SYS_close, f->other_end);
  }
  delete f;
}

void disconnect_files(size_t port, int errno_first) {
  const std::lock_guard<std::mutex> lock(mutex());
  for (const auto& entry : files()) {
    UsbFile* f = entry.load();
    if (f && f->port_number == port) disconnect(*f, errno_first);
  }
}

}  // namespace spidar::test
