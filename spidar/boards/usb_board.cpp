// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/usb_board.h"

#include <algorithm>
#include <utility>

#include "spidar/boards/mouse_board.h"

namespace spidar {
namespace {

/// Position of the rotary switch in `id`; −1 when it contains none.
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
  for (const UsbBoardKind& known : usb_kinds()) {
    if (known.family != family) continue;
    auto transport = std::make_unique<UsbTransport>(name_, known.pipes);
    UsbTransport* const selects = transport.get();
    kinds_.push_back({&known, selects, known.make(name_, profile, std::move(transport))});
  }
}

/// The devices with the path or serial number in the id; without one, all of them.
std::vector<UsbBoard::Candidate> UsbBoard::candidates() {
  std::vector<Candidate> all, named;
  for (Kind& kind : kinds_) {
    for (UsbDeviceInfo& device : list_usb_devices(kind.known->vendor, kind.known->product)) {
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
  if (found.empty()) {
    std::string names;
    for (const Kind& kind : kinds_)
      names += (names.empty() ? "no " : " or ") + std::string(kind.known->name) + " (" +
               kind.known->id() + ")";
    throw DeviceError(name_ + ": " + names + " is plugged in");
  }
  const UsbDeviceInfo& first = found.front().device;
  const bool by_name = !id_.empty() && (first.path == id_ || first.serial == id_);
  if (found.size() == 1 && (by_name || id_.empty())) return open_one(found.front());
  open_matching(found);
}

/// Asks each candidate and keeps the one that reports the wanted rotary switch. Without an id,
/// keeps any that reports the right kind of device.
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

FeltParts UsbBoard::felt_parts() const noexcept {
  return family_ == UsbFamily::kMouse ? MouseBoard::kFelt : FeltParts{};
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
