// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/transports/usb_transport.h"

#include <algorithm>
#include <poll.h>
#include <unistd.h>
#include <utility>

#include <libusb.h>

#include "spidar/device.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/text.h"

namespace spidar {
namespace {

std::string bus_path(libusb_device* device) {
  std::array<uint8_t, 7> ports{};  // the deepest tree that USB allows
  const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  std::string path = std::to_string(libusb_get_bus_number(device));
  for (int i = 0; i < depth; ++i) {
    path += (i == 0 ? '-' : '.') + std::to_string(ports[static_cast<size_t>(i)]);
  }
  return path;
}

/// The serial number as the kernel read it when the device was plugged in; reading it from the
/// device requires opening it.
std::string kernel_serial(const std::string& path) {
  return first_line("/sys/bus/usb/devices/" + path + "/serial");
}

}  // namespace

std::string UsbDeviceInfo::device_file() const {
  return formatted("/dev/bus/usb/%03d/%03d", bus, address);
}

UsbContext make_usb_context() {
  libusb_context* context = nullptr;
  const int error = libusb_init(&context);
  if (error != LIBUSB_SUCCESS) {
    throw DeviceError(std::string("usb: cannot be used: ") + libusb_strerror(error) +
                          "; is there a USB on this machine (/dev/bus/usb)?",
                      DeviceErrorCode::kAbsent);
  }
  return {context, libusb_exit};
}

std::vector<UsbDeviceInfo> list_usb_devices(uint16_t vendor, uint16_t product) {
  const UsbContext context = make_usb_context();
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context.get(), &list);
  std::vector<UsbDeviceInfo> found;
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(list[i], &descriptor) != LIBUSB_SUCCESS ||
        descriptor.idVendor != vendor || descriptor.idProduct != product) {
      continue;
    }
    UsbDeviceInfo info{vendor,
                       product,
                       libusb_get_bus_number(list[i]),
                       libusb_get_device_address(list[i]),
                       bus_path(list[i]),
                       {},
                       false};
    info.serial = kernel_serial(info.path);
    info.accessible = access(info.device_file().c_str(), W_OK) == 0;
    found.push_back(std::move(info));
  }
  if (list) libusb_free_device_list(list, 1);
  std::sort(found.begin(), found.end(),
            [](const UsbDeviceInfo& a, const UsbDeviceInfo& b) { return a.path < b.path; });
  return found;
}

namespace {

constexpr int kInterface = 0;
constexpr int64_t kDrain_ns = 2'000'000;
constexpr int64_t kCancelCheck_ns = 1'000'000;

LinkFault fault_of_submit(int error) noexcept {
  switch (error) {
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return LinkFault::kGone;
    case LIBUSB_ERROR_PIPE:
      return LinkFault::kStall;
    default:
      return LinkFault::kBusError;
  }
}

LinkFault fault_of_control(int error) noexcept {
  if (error == LIBUSB_SUCCESS) return LinkFault::kNone;
  return error == LIBUSB_ERROR_TIMEOUT ? LinkFault::kTimeout : fault_of_submit(error);
}

LinkFault fault_of(libusb_transfer_status status) noexcept {
  switch (status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return LinkFault::kNone;
    case LIBUSB_TRANSFER_STALL:
      return LinkFault::kStall;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return LinkFault::kGone;
    case LIBUSB_TRANSFER_OVERFLOW:
      return LinkFault::kBabble;
    case LIBUSB_TRANSFER_TIMED_OUT:
    case LIBUSB_TRANSFER_CANCELLED:
      return LinkFault::kTimeout;
    case LIBUSB_TRANSFER_ERROR:
      break;
  }
  return LinkFault::kBusError;
}

extern "C" void LIBUSB_CALL mark_done(libusb_transfer* transfer) {
  *static_cast<int*>(transfer->user_data) = 1;
}

DeviceErrorCode error_code_of_usb(int error) noexcept {
  switch (error) {
    case LIBUSB_ERROR_ACCESS:
      return DeviceErrorCode::kForbidden;
    case LIBUSB_ERROR_BUSY:
      return DeviceErrorCode::kBusy;
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return DeviceErrorCode::kAbsent;
    default:
      return DeviceErrorCode::kFailed;
  }
}

std::string advice(int error) {
  switch (error) {
    case LIBUSB_ERROR_ACCESS:
      return "; install the udev rule 70-spidar.rules (spidar/udev/ in the sources) into "
             "/etc/udev/rules.d, run udevadm control --reload, and plug the board in again";
    case LIBUSB_ERROR_BUSY:
      return "; another program uses it, or another element of this one";
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return "; it was unplugged";
    default:
      return "";
  }
}

bool has_endpoint(const libusb_interface_descriptor& setting, uint8_t address, bool interrupt) {
  const int type = interrupt ? LIBUSB_TRANSFER_TYPE_INTERRUPT : LIBUSB_TRANSFER_TYPE_BULK;
  for (int i = 0; i < setting.bNumEndpoints; ++i) {
    const libusb_endpoint_descriptor& endpoint = setting.endpoint[i];
    if (endpoint.bEndpointAddress == address && (endpoint.bmAttributes & 3) == type) return true;
  }
  return false;
}

/// A process that was just killed, or its guardian, may still hold the board.
int claim(libusb_device_handle* handle) {
  const int64_t until_ns = monotonic_now_ns() + Transport::kBusyTimeout_ns;
  int error = libusb_claim_interface(handle, kInterface);
  while (error == LIBUSB_ERROR_BUSY && monotonic_now_ns() < until_ns) {
    sleep_until_ns(monotonic_now_ns() + Transport::kBusyCheck_ns);
    error = libusb_claim_interface(handle, kInterface);
  }
  return error;
}

/// The alternate setting of interface 0 that has both pipes; −1 when there is none.
int setting_with(libusb_device* device, const UsbId& id) {
  libusb_config_descriptor* config = nullptr;
  if (libusb_get_active_config_descriptor(device, &config) != LIBUSB_SUCCESS) return -1;
  int found = -1;
  if (config->bNumInterfaces > kInterface) {
    const libusb_interface& interface = config->interface[kInterface];
    for (int i = interface.num_altsetting - 1; i >= 0; --i) {
      const libusb_interface_descriptor& setting = interface.altsetting[i];
      if (has_endpoint(setting, id.out, id.interrupt) &&
          has_endpoint(setting, id.in, id.interrupt)) {
        found = setting.bAlternateSetting;
      }
    }
  }
  libusb_free_config_descriptor(config);
  return found;
}

/// The file descriptor of the only open device of the context; −1 when there is none. usbfs signals
/// a completed transfer with POLLOUT, and libusb polls no other descriptor for it.
int open_file(libusb_context* context) {
  const libusb_pollfd** const list = libusb_get_pollfds(context);
  int file = -1;
  for (const libusb_pollfd** entry = list; entry && *entry; ++entry) {
    if (((*entry)->events & POLLOUT) != 0) file = (*entry)->fd;
  }
  libusb_free_pollfds(list);
  return file;
}

}  // namespace

std::string UsbId::text() const {
  return formatted("%04x:%04x", vendor, product);
}

UsbTransport::UsbTransport(std::string name, const UsbId& id) : name_(std::move(name)), id_(id) {}

UsbTransport::~UsbTransport() {
  close();
}

void UsbTransport::open() {
  close();
  context_ = make_usb_context();
  for (Slot& slot : slots_) {
    slot.transfer = libusb_alloc_transfer(0);
    if (!slot.transfer) throw DeviceError(name_ + ": no memory for USB transfers");
  }
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context_.get(), &list);
  int error = LIBUSB_ERROR_NO_DEVICE;
  int setting = -1;
  for (ssize_t i = 0; i < count && !handle_; ++i) {
    if (libusb_get_bus_number(list[i]) != device_.bus ||
        libusb_get_device_address(list[i]) != device_.address) {
      continue;
    }
    setting = setting_with(list[i], id_);
    error = libusb_open(list[i], &handle_);
  }
  if (list) libusb_free_device_list(list, 1);
  const std::string file = device_.device_file();
  if (!handle_) {
    close();
    throw DeviceError(
        name_ + ": cannot open " + file + ": " + libusb_strerror(error) + advice(error),
        error_code_of_usb(error));
  }
  if (setting < 0) {
    close();
    throw DeviceError(name_ + ": " + file +
                      " does not have the endpoints of this board; it is "
                      "something else, or its firmware is not loaded");
  }
  libusb_set_auto_detach_kernel_driver(handle_, 1);
  error = claim(handle_);
  if (error == LIBUSB_SUCCESS && setting > 0) {
    error = libusb_set_interface_alt_setting(handle_, kInterface, setting);
  }
  if (error != LIBUSB_SUCCESS) {
    close();
    throw DeviceError(
        name_ + ": cannot claim " + file + ": " + libusb_strerror(error) + advice(error),
        error_code_of_usb(error));
  }
}

LinkFault UsbTransport::submit(Slot& slot, uint8_t endpoint, size_t length) noexcept {
  const auto bytes = static_cast<int>(length);
  if (id_.interrupt) {
    libusb_fill_interrupt_transfer(slot.transfer, handle_, endpoint, slot.bytes.data(), bytes,
                                   mark_done, &slot.done, 0);
  } else {
    libusb_fill_bulk_transfer(slot.transfer, handle_, endpoint, slot.bytes.data(), bytes, mark_done,
                              &slot.done, 0);
  }
  slot.done = 0;
  const int error = libusb_submit_transfer(slot.transfer);
  if (error == LIBUSB_SUCCESS) return LinkFault::kNone;
  slot.done = 1;
  return fault_of_submit(error);
}

bool UsbTransport::in_flight() const noexcept {
  return std::any_of(slots_.begin(), slots_.end(), [](const Slot& s) { return s.done == 0; });
}

/// Handles events until no transfer is in flight; from the deadline on, cancels the transfers.
void UsbTransport::finish(int64_t deadline_ns) noexcept {
  bool cancelled = false;
  while (in_flight()) {
    const int64_t left_ns = deadline_ns - monotonic_now_ns();
    if (left_ns <= 0 && !cancelled) {
      for (Slot& slot : slots_) {
        if (slot.done == 0) libusb_cancel_transfer(slot.transfer);
      }
      cancelled = true;
    }
    const int64_t wait_ns = cancelled ? kCancelCheck_ns : left_ns;
    timeval wait{static_cast<time_t>(wait_ns / kSecond_ns),
                 static_cast<suseconds_t>(wait_ns % kSecond_ns / 1000)};
    for (Slot& slot : slots_) {
      if (slot.done != 0) continue;
      libusb_handle_events_timeout_completed(context_.get(), &wait, &slot.done);
      break;
    }
  }
}

Transfer UsbTransport::transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                                int64_t deadline_ns) noexcept {
  if (!handle_) return {LinkFault::kGone, 0};
  if (packets.size() > kMaxPackets || reply.size > kMaxLength) return {LinkFault::kWrongReply, 0};
  LinkFault fault = LinkFault::kNone;
  Slot& in = slots_.back();
  if (reply.size > 0) fault = submit(in, id_.in, reply.size);
  size_t used = 0;
  for (const ByteView packet : packets) {
    if (fault != LinkFault::kNone) break;
    Slot& slot = slots_[used++];
    const size_t length = std::min(packet.size, kMaxLength);
    std::copy_n(packet.data, length, slot.bytes.begin());
    fault = submit(slot, id_.out, length);
  }
  // After a packet that was not sent there is no reply.
  finish(fault == LinkFault::kNone ? deadline_ns : 0);
  if (fault != LinkFault::kNone) return {fault, 0};

  for (size_t i = 0; i < used; ++i) {
    const libusb_transfer& out = *slots_[i].transfer;
    fault = fault_of(out.status);
    if (fault == LinkFault::kNone && out.actual_length != out.length) fault = LinkFault::kShort;
    if (fault == LinkFault::kStall) out_stalled_ = true;
    if (fault != LinkFault::kNone) return {fault, 0};
  }
  if (reply.size == 0) return {};
  fault = fault_of(in.transfer->status);
  const auto received = static_cast<size_t>(std::max(in.transfer->actual_length, 0));
  if (fault == LinkFault::kNone && received < reply.size) fault = LinkFault::kShort;
  std::copy_n(in.bytes.begin(), std::min(received, reply.size), reply.data);
  return {fault, received};
}

LinkFault UsbTransport::control(const VendorRequest& request, int64_t deadline_ns) noexcept {
  if (!handle_) return LinkFault::kGone;
  // A timeout of zero would never end.
  const auto left_ms = std::max<int64_t>((deadline_ns - monotonic_now_ns()) / 1'000'000, 1);
  return fault_of_control(libusb_control_transfer(handle_, ftdi::kRequestType, request.request,
                                                  request.value, 0, nullptr, 0,
                                                  static_cast<unsigned>(left_ms)));
}

void UsbTransport::recover() noexcept {
  if (!handle_) return;
  // Unless there is a stall, the published hosts reset only the pipe of the replies.
  if (out_stalled_) libusb_clear_halt(handle_, id_.out);
  out_stalled_ = false;
  libusb_clear_halt(handle_, id_.in);
  // Drops replies to exchanges that timed out; a board buffers a few of them.
  std::array<uint8_t, kMaxLength> old{};
  for (int i = 0; i < 4; ++i) {
    const Transfer transfer = exchange({}, old, monotonic_now_ns() + kDrain_ns);
    if (transfer.fault != LinkFault::kNone && transfer.fault != LinkFault::kShort) break;
  }
}

std::optional<LastWill> UsbTransport::last_will() const {
  LastWill will;
  will.wire = LastWill::Wire::kUsb;
  will.interface_number = kInterface;
  will.endpoint = id_.out;
  will.file = open_file(context_.get());
  if (will.file < 0) {
    throw DeviceError(name_ + ": libusb does not say which file it has opened for the board");
  }
  return will;
}

void UsbTransport::close() noexcept {
  if (handle_) {
    libusb_release_interface(handle_, kInterface);
    libusb_close(handle_);
    handle_ = nullptr;
  }
  // A transfer refers to the device to which it was last submitted, and that device to its context.
  for (Slot& slot : slots_) {
    libusb_free_transfer(slot.transfer);
    slot.transfer = nullptr;
  }
  context_.reset();
}

}  // namespace spidar
