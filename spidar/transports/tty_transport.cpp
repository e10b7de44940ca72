// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/transports/tty_transport.h"

#include <algorithm>
#include <asm/termbits.h>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <linux/serial.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "spidar/device.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/realtime/uninterrupted.h"
#include "spidar/text.h"

namespace spidar {
namespace {

bool begins(const std::string& name, const char* with) {
  return name.rfind(with, 0) == 0;
}

}  // namespace

std::vector<TtyLine> list_tty_lines(const std::string& folder) {
  std::vector<TtyLine> lines;
  std::error_code error;
  // A folder that cannot be listed counts as empty.
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool named = begins(name, "spidar");
    if (named || begins(name, "ttyUSB") || begins(name, "ttyACM")) {
      lines.push_back({entry->path().string(), named});
    }
  }
  std::sort(lines.begin(), lines.end(),
            [](const TtyLine& a, const TtyLine& b) { return a.path < b.path; });
  return lines;
}

DeviceIdentity tty_identity(const std::string& path, const std::string& sysfs) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path line = fs::canonical(path, error);
  if (error) line = path;
  fs::path device =
      fs::canonical(sysfs + "/class/tty/" + line.filename().string() + "/device", error);
  if (error) device.clear();
  const auto attribute = [&device](const char* name) { return first_line(device / name); };
  // The line is a part of an interface of the adapter, which is the first device with a vendor.
  std::string interface;
  for (; device.has_relative_path(); device = device.parent_path()) {
    if (interface.empty()) interface = attribute("bInterfaceNumber");
    const std::string vendor = attribute("idVendor");
    if (vendor.empty()) continue;
    return {attribute("product") + " (" + vendor + ":" + attribute("idProduct") + ") interface " +
                interface,
            attribute("serial"), device.filename().string()};
  }
  return {"serial line", "", line.string()};
}

namespace {

LinkFault fault_of_line(int error) noexcept {
  // A USB adapter that was pulled out returns EIO or ENXIO.
  return error == EIO || error == ENXIO || error == ENODEV || error == EBADF ? LinkFault::kGone
                                                                             : LinkFault::kBusError;
}

/// Sets raw mode, 8N1, at any speed through termios2, as some systems have no constant for 2 Mbaud.
bool set_raw(int file, int baud) noexcept {
  termios2 settings{};
  if (call_ioctl(file, TCGETS2, &settings) != 0) return false;
  settings.c_iflag = 0;
  settings.c_oflag = 0;
  settings.c_lflag = 0;
  settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;
  settings.c_ispeed = static_cast<speed_t>(baud);
  settings.c_ospeed = static_cast<speed_t>(baud);
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  return call_ioctl(file, TCSETS2, &settings) == 0;
}

/// FTDI adapters otherwise collect bytes for 16 ms. Other drivers do not support this request, and
/// pseudo terminals do not need it.
void ask_for_low_latency(int file) noexcept {
  serial_struct serial{};
  if (ioctl(file, TIOCGSERIAL, &serial) != 0) return;
  serial.flags |= ASYNC_LOW_LATENCY;
  ioctl(file, TIOCSSERIAL, &serial);
}

}  // namespace

TtyTransport::TtyTransport(std::string name, std::string path, int baud)
    : name_(std::move(name)), path_(std::move(path)), baud_(baud) {}

TtyTransport::~TtyTransport() {
  close();
}

void TtyTransport::fail(const std::string& what, SourceLocation location) {
  const int error = errno;
  close();
  std::string advice;
  if (error == EACCES) {
    advice =
        "; join the group of that file (dialout), or name the adapter in the udev rule "
        "70-spidar.rules";
  }
  if (error == ENOENT) {
    advice = "; serial lines have names such as /dev/ttyUSB0 and /dev/serial/by-id/…";
  }
  if (error == ENOTTY) advice = "; it is no serial line";
  if (error == EWOULDBLOCK) advice = "; another program uses it, or another element of this one";
  throw DeviceError(name_ + ": " + what + ": " + std::strerror(error) + advice,
                    error_code_of(error), location);
}

void TtyTransport::open() {
  close();
  // Check before opening: opening another device may have unknown effects.
  if (first_.known() && access(path_.c_str(), F_OK) == 0) {
    first_.require(name_, tty_identity(path_));
  }
  file_ = uninterrupted(
      [&] { return ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC); });
  if (file_ < 0) fail("cannot be opened");
  if (!lock_device(file_)) fail("cannot be locked");
  try {
    first_.require(name_, tty_identity(path_));
  } catch (...) {
    close();
    throw;
  }
  if (!set_raw(file_, baud_)) fail("cannot be set to " + std::to_string(baud_) + " baud");
  ask_for_low_latency(file_);
  // DTR and RTS are low, as published; not every line has them.
  const int lines = TIOCM_DTR | TIOCM_RTS;
  ioctl(file_, TIOCMBIC, &lines);
}

LinkFault TtyTransport::wait_for(short events, int64_t deadline_ns) noexcept {
  for (;;) {
    const int64_t left_ns = deadline_ns - monotonic_now_ns();
    if (left_ns <= 0) return LinkFault::kTimeout;
    pollfd file{file_, events, 0};
    const timespec wait = to_timespec(left_ns);
    const int ready = ppoll(&file, 1, &wait, nullptr);
    if (ready < 0 && errno != EINTR) return fault_of_line(errno);
    if (ready <= 0) continue;
    if (file.revents & events) return LinkFault::kNone;
    return LinkFault::kGone;  // hung up
  }
}

Transfer TtyTransport::transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                                int64_t deadline_ns) noexcept {
  if (file_ < 0) return {LinkFault::kGone, 0};
  for (ByteView packet : packets) {
    while (packet.size > 0) {
      const ssize_t sent = write(file_, packet.data, packet.size);
      if (sent < 0 && errno != EAGAIN && errno != EINTR) return {fault_of_line(errno), 0};
      if (sent <= 0) {
        const LinkFault fault = wait_for(POLLOUT, deadline_ns);
        if (fault != LinkFault::kNone) return {fault, 0};
        continue;
      }
      packet.data += sent;
      packet.size -= static_cast<size_t>(sent);
    }
  }
  size_t received = 0;
  while (received < reply.size) {
    const LinkFault fault = wait_for(POLLIN, deadline_ns);
    if (fault == LinkFault::kTimeout && received > 0) return {LinkFault::kShort, received};
    if (fault != LinkFault::kNone) return {fault, received};
    const ssize_t got = read(file_, reply.data + received, reply.size - received);
    if (got < 0 && errno != EAGAIN && errno != EINTR) return {fault_of_line(errno), received};
    if (got > 0) received += static_cast<size_t>(got);
    if (got == 0) return {LinkFault::kGone, received};
  }
  return {LinkFault::kNone, received};
}

Transport::StaleData TtyTransport::drop_stale_data(int64_t) noexcept {
  int unread = 0;
  ioctl(file_, FIONREAD, &unread);
  if (unread == 0) return StaleData::kNone;
  ioctl(file_, TCFLSH, TCIFLUSH);
  return StaleData::kDropped;
}

void TtyTransport::recover() noexcept {
  if (file_ >= 0) ioctl(file_, TCFLSH, TCIOFLUSH);
}

std::optional<LastWill> TtyTransport::last_will() const {
  LastWill will;
  will.wire = LastWill::Wire::kTerminal;
  will.file = file_;
  return will;
}

void TtyTransport::close() noexcept {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

}  // namespace spidar
