// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/boards/usb_board.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "spidar/boards/cyverse_board.h"
#include "spidar/boards/falcon_board.h"
#include "spidar/boards/mouse_board.h"
#include "spidar/device.h"
#include "spidar/transports/usb_bus.h"

namespace spidar {
namespace {

template <typename BoardType>
std::unique_ptr<Board> make(const std::string& name, const Profile& profile,
                            std::unique_ptr<Transport> transport) {
  return std::make_unique<BoardType>(name, profile, std::move(transport));
}

template <typename BoardType>
std::unique_ptr<ForceBoard> make_force(const std::string& name,
                                       std::unique_ptr<Transport> transport) {
  return std::make_unique<BoardType>(name, std::move(transport));
}

}  // namespace

std::string UsbBoardKind::id() const {
  char text[16];
  std::snprintf(text, sizeof text, "%04x:%04x", vendor, product);
  return text;
}

const std::vector<UsbBoardKind>& usb_kinds() {
  // Never destroyed: when a player exits, another thread may still be reopening its board.
  static const auto& kinds = *new std::vector<UsbBoardKind>{
      {UsbFamily::kCyverse,
       sh4::kVendor,
       sh4::kProduct,
       "CyVerse USB 2.0 SH4",
       "usb-sh4",
       Trial::kEmulated,
       "endpoints and D/A range are inferred",
       {sh4::kEndpointOut, sh4::kEndpointIn, false},
       make<Sh4Board>,
       nullptr},
      {UsbFamily::kCyverse,
       usb_simple::kVendor,
       usb_simple::kProduct,
       "CyVerse USB 2.0 Simple",
       "usb-simple",
       Trial::kEmulated,
       "endpoints and D/A range are inferred",
       {usb_simple::kEndpointOut, usb_simple::kEndpointIn, false},
       make<SimpleBoard>,
       nullptr},
      {UsbFamily::kMouse,
       mouse::kVendor,
       mouse::kProduct,
       "SPIDAR-mouse",
       "",
       Trial::kInferred,
       "other devices have this id; asked when it is opened",
       {mouse::kEndpointOut, mouse::kEndpointIn, true},
       nullptr,
       make_force<MouseBoard>},
      {UsbFamily::kFalcon,
       falcon::kVendor,
       falcon::kProduct,
       "Novint Falcon",
       "",
       Trial::kEmulated,
       "reach and scale of the force are inferred",
       {falcon::kEndpointOut, falcon::kEndpointIn, false},
       nullptr,
       make_force<FalconBoard>},
  };
  return kinds;
}

const char* device_of(UsbFamily family) noexcept {
  switch (family) {
    case UsbFamily::kCyverse:
      return "usb";
    case UsbFamily::kMouse:
      return "mouse";
    case UsbFamily::kFalcon:
      return "falcon";
  }
  return "";
}

int rotary_of(const std::string& id) {
  const bool digits =
      !id.empty() && id.size() <= 2 &&
      std::all_of(id.begin(), id.end(), [](char c) { return c >= '0' && c <= '9'; });
  const int number = digits ? std::stoi(id) : -1;
  return number <= 15 ? number : -1;
}

UsbSearch::UsbSearch(UsbFamily family, std::string name, std::string id)
    : family_(family), name_(std::move(name)), id_(std::move(id)) {}

/// The devices with the path or serial number in the id; without one, all of them.
std::vector<UsbSearch::Candidate> UsbSearch::candidates() const {
  std::vector<Candidate> all, named;
  for (const UsbBoardKind& kind : usb_kinds()) {
    if (kind.family != family_) continue;
    for (UsbDeviceInfo& device : list_usb_devices(kind.vendor, kind.product)) {
      const bool meant = !id_.empty() && (device.path == id_ || device.serial == id_);
      (meant ? named : all).push_back({&kind, std::move(device)});
    }
  }
  return named.empty() ? all : named;
}

void UsbSearch::open(const Open& open, const std::function<void()>& close) const {
  const std::vector<Candidate> found = candidates();
  if (found.empty()) {
    std::string names;
    for (const UsbBoardKind& kind : usb_kinds())
      if (kind.family == family_)
        names += (names.empty() ? "no " : " or ") + std::string(kind.name) + " (" + kind.id() + ")";
    throw DeviceError(name_ + ": " + names + " is plugged in");
  }
  const UsbDeviceInfo& first = found.front().device;
  const bool by_name = !id_.empty() && (first.path == id_ || first.serial == id_);
  if (found.size() == 1 && (by_name || id_.empty()))
    open(found.front());
  else
    open_matching(found, open, close);
}

/// Asks each candidate and keeps the one that reports the wanted rotary switch. Without an id,
/// keeps any that reports the right kind of device.
void UsbSearch::open_matching(const std::vector<Candidate>& found, const Open& open,
                              const std::function<void()>& close) const {
  const int wanted = rotary_of(id_);
  const bool ask = family_ == UsbFamily::kMouse || wanted >= 0;
  std::string listed, trouble;
  for (const Candidate& candidate : found) {
    listed += std::string(" ") + device_of(family_) + ":" + candidate.device.path;
    if (!ask) continue;
    try {
      const int rotary = open(candidate);
      if (rotary == wanted) return;
      listed += " (rotary switch " + std::to_string(rotary) + ")";
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

UsbBoard::UsbBoard(std::string name, std::string id, const Profile& profile)
    : name_(std::move(name)),
      profile_name_(profile.name),
      profile_board_(profile.board),
      search_(UsbFamily::kCyverse, name_, std::move(id)) {
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
    if (profile_board_ != "unknown" && profile_board_ != kind.known->profile_board)
      throw DeviceError(
          name_ + ": the board at " + candidate.device.path + " is a " + kind.known->name +
          ", and profile \"" + profile_name_ + "\" is for boards of the kind " + profile_board_ +
          "; spidarctl info usb:" + candidate.device.path + " lists the profiles that fit");
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

UsbForceBoard::UsbForceBoard(UsbFamily family, const std::string& name, const std::string& id)
    : search_(family, name, id) {
  for (const UsbBoardKind& kind : usb_kinds()) {
    if (kind.family != family || kind.make_force == nullptr) continue;
    auto transport = std::make_unique<UsbTransport>(name, kind.pipes);
    transport_ = transport.get();
    board_ = kind.make_force(name, std::move(transport));
  }
  if (!board_) throw DeviceError(name + ": no USB device of this family takes a force");
}

void UsbForceBoard::open() {
  close();
  search_.open(
      [this](const UsbSearch::Candidate& candidate) {
        transport_->select(candidate.device);
        board_->open();
        path_ = candidate.device.path;
        return -1;  // it has no rotary switch
      },
      [this] { close(); });
}

}  // namespace spidar
