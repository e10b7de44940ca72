#include "spidar/boards/usb_board.h"

#include <algorithm>
#include <utility>

#include "spidar/boards/mouse_board.h"
#include "spidar/boards/sh4_board.h"
#include "spidar/boards/simple_board.h"

namespace spidar {
namespace {

template <typename BoardType>
std::unique_ptr<Board> make_board(const std::string& name, const Profile& profile,
                                  const UsbPipes& pipes, UsbTransport*& transport) {
  auto owned = std::make_unique<UsbTransport>(name, pipes);
  transport = owned.get();
  return std::make_unique<BoardType>(name, profile, std::move(owned));
}

/// The rotary switch's position that `id` names; −1 when it names none.
int rotary_of(const std::string& id) {
  const bool digits =
      !id.empty() && id.size() <= 2 &&
      std::all_of(id.begin(), id.end(), [](char c) { return c >= '0' && c <= '9'; });
  const int number = digits ? std::stoi(id) : -1;
  return number <= 15 ? number : -1;
}

}  // namespace

UsbBoard::UsbBoard(UsbFamily family, std::string name, std::string id, const Profile& profile)
    : family_(family), name_(std::move(name)), id_(std::move(id)) {
  const auto add = [&](uint16_t vendor, uint16_t product, const UsbPipes& pipes, auto make) {
    Kind kind{vendor, product, nullptr, nullptr};
    kind.board = make(name_, profile, pipes, kind.transport);
    kinds_.push_back(std::move(kind));
  };
  if (family_ == UsbFamily::kMouse) {
    add(mouse::kVendor, mouse::kProduct, {mouse::kEndpointOut, mouse::kEndpointIn, true},
        make_board<MouseBoard>);
    return;
  }
  add(sh4::kVendor, sh4::kProduct, {sh4::kEndpointOut, sh4::kEndpointIn, false},
      make_board<Sh4Board>);
  add(usb_simple::kVendor, usb_simple::kProduct,
      {usb_simple::kEndpointOut, usb_simple::kEndpointIn, false}, make_board<SimpleBoard>);
}

/// Those that the id names by path or serial; else all of them.
std::vector<UsbBoard::Candidate> UsbBoard::candidates() {
  std::vector<Candidate> all, named;
  for (Kind& kind : kinds_) {
    for (UsbDeviceInfo& device : list_usb_devices(kind.vendor, kind.product)) {
      const bool meant = !id_.empty() && (device.path == id_ || device.serial == id_);
      (meant ? named : all).push_back({&kind, std::move(device)});
    }
  }
  return named.empty() ? all : named;
}

void UsbBoard::open_one(const Candidate& candidate) {
  candidate.kind->transport->select(candidate.device);
  candidate.kind->board->open();
  used_ = candidate.kind;
  used_path_ = candidate.device.path;
}

void UsbBoard::open() {
  close();
  const std::vector<Candidate> found = candidates();
  if (found.empty())
    throw DeviceError(name_ + (family_ == UsbFamily::kMouse
                                   ? ": no SPIDAR-mouse (04d8:003f) is plugged in"
                                   : ": no CyVerse board (0cec:0205 or 0cec:0203) is plugged in"));
  const UsbDeviceInfo& first = found.front().device;
  const bool by_name = !id_.empty() && (first.path == id_ || first.serial == id_);
  if (found.size() == 1 && (by_name || id_.empty())) return open_one(found.front());
  open_matching(found);
}

/// The one that says what is asked for, when each is asked. Without an id, any that says it is the
/// right kind of device.
void UsbBoard::open_matching(const std::vector<Candidate>& found) {
  const int wanted = rotary_of(id_);
  const bool ask = family_ == UsbFamily::kMouse || wanted >= 0;
  std::string listed, trouble;
  for (const Candidate& candidate : found) {
    listed += " usb:" + candidate.device.path;
    if (!ask) continue;
    try {
      open_one(candidate);
      if (rotary() == wanted) return;
      listed += " (rotary switch " + std::to_string(rotary()) + ")";
      close();
    } catch (const DeviceError& error) {
      trouble += std::string("; ") + error.what();
    }
  }
  const std::string what =
      id_.empty()
          ? "there are several boards, name one of"
          : "no board has the bus path, serial number or rotary switch " + id_ + "; there are";
  throw DeviceError(name_ + ": " + what + listed + trouble);
}

std::string UsbBoard::description() const {
  return used_ ? "at " + used_path_ + ": " + used_->board->description() : "";
}

LinkFault UsbBoard::cycle(const MotorVolts& volts, DeviceReading& reading,
                          int64_t deadline_ns) noexcept {
  return used_ ? used_->board->cycle(volts, reading, deadline_ns) : LinkFault::kGone;
}

void UsbBoard::recover() noexcept {
  if (used_) used_->board->recover();
}

void UsbBoard::zero_counts() noexcept {
  if (used_) used_->board->zero_counts();
}

void UsbBoard::close() noexcept {
  if (used_) used_->board->close();
  used_ = nullptr;
}

std::vector<LastWill> UsbBoard::last_wills() const {
  return used_ ? used_->board->last_wills() : std::vector<LastWill>{};
}

}  // namespace spidar
