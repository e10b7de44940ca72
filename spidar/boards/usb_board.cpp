// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/usb_board.h"

#include <utility>

namespace spidar {

UsbBoard::UsbBoard(std::string name, std::string id, const Profile& profile)
    : name_(std::move(name)), search_(UsbFamily::kCyverse, name_, std::move(id)) {
  for (const UsbBoardKind& known : usb_kinds()) {
    if (known.make == nullptr) continue;
    auto transport = std::make_unique<UsbTransport>(name_, known.pipes);
    UsbTransport* const selects = transport.get();
    kinds_.push_back({&known, selects, known.make(name_, profile, std::move(transport))});
  }
}

void UsbBoard::open_one(const UsbSearch::Candidate& candidate) {
  for (Kind& kind : kinds_) {
    if (kind.known != candidate.kind) continue;
    kind.transport->select(candidate.device);
    kind.board->open();
    used_ = &kind;
    used_path_ = candidate.device.path;
  }
}

void UsbBoard::open() {
  close();
  search_.open(
      [this](const UsbSearch::Candidate& candidate) {
        open_one(candidate);
        return rotary();
      },
      [this] { close(); });
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
