// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "tests/kernel/usbip_board.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fcntl.h>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

#include "spidar/realtime/monotonic.h"
#include "tests/emulated_bus/descriptors.h"

namespace spidar::test {
namespace {

constexpr const char* kAttach = "/sys/devices/platform/vhci_hcd.0/attach";
/// No request of a driver of these boards is longer; the kernel's own are shorter.
constexpr size_t kMaxLength = 4096;

// Standard requests and descriptors, USB 2.0, tables 9-4 and 9-5.
constexpr uint8_t kGetStatus = 0, kClearFeature = 1, kGetDescriptor = 6, kSetConfiguration = 9,
                  kSetInterface = 11;
constexpr uint8_t kDevice = 1, kConfiguration = 2, kString = 3;
constexpr size_t kDeviceLength = 18;

bool read_all(int socket, void* bytes, size_t size) {
  return size == 0 || recv(socket, bytes, size, MSG_WAITALL) == static_cast<ssize_t>(size);
}

/// Waits while the kernel is still detaching the previous board from the host controller.
void attach(int socket, bool full_speed) {
  // Port 0, a device number that only messages show, the speed: 2 full, 3 high.
  const std::string line = "0 " + std::to_string(socket) + " 65538 " + (full_speed ? "2" : "3");
  for (;;) {
    const int file = open(kAttach, O_WRONLY | O_CLOEXEC);
    const bool written = file >= 0 && write(file, line.data(), line.size()) >= 0;
    const int error = errno;
    if (file >= 0) close(file);
    if (written) return;
    if (error != EBUSY) throw std::system_error(error, std::generic_category(), kAttach);
    sleep_until_ns(monotonic_now_ns() + kSecond_ns / 100);
  }
}

}  // namespace

UsbipBoard::UsbipBoard(std::shared_ptr<emulated::Motors> motors, std::string serial,
                       const std::string& board)
    : motors_(std::move(motors)),
      serial_(std::move(serial)),
      kind_(*simulated_kind(DeviceName("sim:" + board))) {}

UsbipBoard::~UsbipBoard() {
  unplug();
}

void UsbipBoard::plug() {
  unplug();
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw std::system_error(errno, std::generic_category(), "socketpair");
  socket_ = ends[0];
  unplug_in_transfer_ = false;
  thread_ = std::thread([this] { serve(socket_); });
  attach(ends[1], kind_.usb.full_speed);
  close(ends[1]);
}

void UsbipBoard::unplug() {
  if (!thread_.joinable()) return;
  shutdown(socket_, SHUT_RDWR);
  thread_.join();
  close(socket_);
}

void UsbipBoard::serve(int socket) {
  memory_.loaded = false;
  memory_.baud = 0;
  const auto board = kind_.emulate(motors_);
  board->remember(memory_);
  board_ = board.get();
  waiting_.clear();
  UsbipHeader header;
  while (read_all(socket, header.data(), header.size())) {
    const UsbipRequest request = decode_usbip(header);
    const bool submitted = request.command == UsbipCommand::kSubmit;
    std::vector<uint8_t> data(submitted && !request.in ? request.length : 0);
    if (request.length > kMaxLength || !read_all(socket, data.data(), data.size())) break;
    if (!(submitted ? take(request, data) : unlink(request))) break;
  }
  abandoned_ = waiting_.size();
  shutdown(socket, SHUT_RDWR);
}

/// Returns false to pull the board out.
bool UsbipBoard::take(const UsbipRequest& request, const std::vector<uint8_t>& data) {
  if (request.endpoint == 0) return control(request);
  constexpr uint8_t kNumber = 0x0F;  // of an endpoint, without its direction
  if (request.in && request.endpoint == (kind_.usb.in & kNumber)) {
    waiting_.push_back(request);
    return !unplug_in_transfer_ && answer();
  }
  if (request.in || request.endpoint != kind_.usb.out)
    return reply(UsbipCommand::kSubmitReply, request.sequence, -EPIPE);
  board_->receive({data.data(), data.size()});
  return reply(UsbipCommand::kSubmitReply, request.sequence, 0, data.size()) && answer();
}

/// Copies the board's replies into the waiting requests.
bool UsbipBoard::answer() {
  std::array<uint8_t, kMaxLength> bytes{};
  while (!waiting_.empty()) {
    const size_t length = board_->reply({bytes.data(), waiting_.front().length});
    if (length == 0) return true;
    if (!reply_with(waiting_.front(), {reinterpret_cast<const char*>(bytes.data()), length}))
      return false;
    waiting_.pop_front();
  }
  return true;
}

bool UsbipBoard::unlink(const UsbipRequest& request) {
  const auto at = std::find_if(waiting_.begin(), waiting_.end(), [&](const UsbipRequest& waits) {
    return waits.sequence == request.unlink;
  });
  const bool waits = at != waiting_.end();
  if (waits) waiting_.erase(at);
  return reply(UsbipCommand::kUnlinkReply, request.sequence, waits ? -ECONNRESET : 0);
}

bool UsbipBoard::control(const UsbipRequest& request) {
  const auto& setup = request.setup;
  if (setup[0] == ftdi::kRequestType && board_->control({setup[1], ByteView(setup).u16(2)}))
    return reply(UsbipCommand::kSubmitReply, request.sequence, 0);
  switch (setup[1]) {
    case kGetDescriptor: {
      const std::string data = descriptor(setup[3], setup[2]);
      if (!data.empty()) return reply_with(request, data);
      break;
    }
    case kGetStatus:
      return reply_with(request, std::string(2, '\0'));
    case kClearFeature:
    case kSetConfiguration:
    case kSetInterface:
      return reply(UsbipCommand::kSubmitReply, request.sequence, 0);
    default:
      break;
  }
  return reply(UsbipCommand::kSubmitReply, request.sequence, -EPIPE);
}

/// Empty: there is none.
std::string UsbipBoard::descriptor(uint8_t type, uint8_t index) const {
  const std::string all = descriptors_of(kind_);
  if (type == kDevice) return all.substr(0, kDeviceLength);
  if (type == kConfiguration) return all.substr(kDeviceLength);
  if (type != kString) return {};
  if (index == 0) return {4, kString, 0x09, 0x04};  // US English
  std::string text{static_cast<char>(2 + 2 * serial_.size()), kString};
  for (const char c : serial_) text += {c, '\0'};
  return text;
}

bool UsbipBoard::reply(UsbipCommand command, uint32_t sequence, int status, size_t length) {
  const UsbipHeader header = encode_usbip_reply(command, sequence, status, length);
  return send(socket_, header.data(), header.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(header.size());
}

bool UsbipBoard::reply_with(const UsbipRequest& request, const std::string& data) {
  const size_t length = std::min<size_t>(data.size(), request.length);
  return reply(UsbipCommand::kSubmitReply, request.sequence, 0, length) &&
         send(socket_, data.data(), length, MSG_NOSIGNAL) == static_cast<ssize_t>(length);
}

}  // namespace spidar::test
