// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#include "spidar/devices/usb_search.h"

#include <algorithm>
#include <map>
#include <utility>
#include <variant>

#include "spidar/device.h"

namespace spidar {

int rotary_of(const std::string& id) {
  const bool digits =
      !id.empty() && id.size() <= 2 &&
      std::all_of(id.begin(), id.end(), [](char c) { return c >= '0' && c <= '9'; });
  const int number = digits ? std::stoi(id) : -1;
  return number <= 15 ? number : -1;
}

UsbSearch::UsbSearch(std::vector<const DeviceKind*> kinds, std::string name, std::string id)
    : kinds_(std::move(kinds)), name_(std::move(name)), id_(std::move(id)) {}

DeviceIdentity UsbSearch::Candidate::identity() const {
  return {std::string(kind->title) + " (" + kind->usb.text() + ")", device.serial, device.path};
}

/// Returns all devices of these kinds, first those with the path or serial number in the id.
std::vector<UsbSearch::Candidate> UsbSearch::plugged_in() const {
  std::vector<Candidate> all;
  for (const DeviceKind* kind : kinds_) {
    for (UsbDeviceInfo& device : list_usb_devices(kind->usb.vendor, kind->usb.product)) {
      all.push_back({kind, std::move(device)});
    }
  }
  std::stable_partition(all.begin(), all.end(),
                        [this](const Candidate& one) { return is_named(one); });
  return all;
}

bool UsbSearch::is_named(const Candidate& candidate) const {
  return !id_.empty() && (candidate.device.path == id_ || candidate.device.serial == id_);
}

/// Returns devices, at least one: those with the id's path or serial number or, without an id, all.
std::vector<UsbSearch::Candidate> UsbSearch::candidates() const {
  std::vector<Candidate> found = plugged_in();
  if (!found.empty() && is_named(found.front())) {
    found.erase(std::find_if_not(found.begin(), found.end(),
                                 [this](const Candidate& one) { return is_named(one); }),
                found.end());
  }
  if (found.empty()) {
    std::string names;
    for (const DeviceKind* kind : kinds_) {
      names += (names.empty() ? "no " : " or ") + std::string(kind->title) + " (" +
               kind->usb.text() + ")";
    }
    throw DeviceError(name_ + ": " + names + " is plugged in", DeviceErrorCode::kAbsent);
  }
  return found;
}

bool UsbSearch::is_unambiguous(const std::vector<Candidate>& found) const {
  return found.size() == 1 && (is_named(found.front()) || id_.empty());
}

/// Returns whether only the boards themselves can tell which one is meant.
bool UsbSearch::must_query(const std::vector<Candidate>& found) const {
  return found.front().kind->usb.shared || rotary_of(id_) >= 0;
}

void UsbSearch::require_one() const {
  const std::vector<Candidate> found = candidates();
  if (!is_unambiguous(found) && !must_query(found)) open_matching(found, {}, {});
}

void UsbSearch::open(const std::function<int(const Candidate&)>& open,
                     const std::function<void()>& close) {
  if (first_.known()) return open_again(open);
  const std::vector<Candidate> found = candidates();
  Candidate opened = found.front();
  if (is_unambiguous(found)) {
    first_rotary_ = open(opened);
  } else {
    opened = open_matching(found, open, close);
    first_rotary_ = rotary_of(id_);
  }
  first_.require(name_, opened.identity());
}

/// The rotary switch also distinguishes boards without a serial number.
void UsbSearch::open_again(const std::function<int(const Candidate&)>& open) const {
  const std::vector<Candidate> found = plugged_in();
  const auto same = std::find_if(found.begin(), found.end(), [&](const Candidate& candidate) {
    return first_.is(candidate.identity());
  });
  if (same == found.end()) {
    const bool other = !found.empty() && !found.front().kind->usb.shared;
    if (other) throw first_.other(name_, found.front().identity());
    throw DeviceError(name_ + ": " + first_.text() + " is not plugged in",
                      DeviceErrorCode::kAbsent);
  }
  const int rotary = open(*same);
  if (rotary == first_rotary_) return;
  DeviceIdentity changed = same->identity();
  changed.model += ", rotary switch " + std::to_string(rotary);
  throw first_.other(name_, changed);
}

/// Opens the candidates until one reports the wanted rotary switch. Without an id, accepts any
/// candidate that reports the right kind of device.
UsbSearch::Candidate UsbSearch::open_matching(const std::vector<Candidate>& found,
                                              const std::function<int(const Candidate&)>& open,
                                              const std::function<void()>& close) const {
  const int wanted = rotary_of(id_);
  std::string listed, errors;
  for (const Candidate& candidate : found) {
    listed += std::string(" ") + candidate.kind->device + ":" + candidate.device.path;
    if (!must_query(found)) continue;
    try {
      const int rotary = open(candidate);
      if (rotary == wanted) return candidate;
      listed += " (rotary switch " + std::to_string(rotary) + ")";
    } catch (const DeviceError& error) {
      errors += std::string("; ") + error.what();
    }
    close();
  }
  const std::string what =
      id_.empty()
          ? "there are several boards, name one of"
          : "no board has the bus path, serial number or rotary switch " + id_ + "; there are";
  throw DeviceError(name_ + ": " + what + listed + errors,
                    id_.empty() ? DeviceErrorCode::kSettings : DeviceErrorCode::kAbsent);
}

namespace {

void require_profile_for(const UsbSearch::Candidate& found, const std::string& name,
                         const std::string& profile, const std::string& profile_board) {
  if (!found.kind->has_strings() || profile_board == kUnknownBoard ||
      profile_board == found.kind->profile_board) {
    return;
  }
  throw DeviceError(name + ": the board at " + found.device.path + " is a " + found.kind->title +
                        ", and profile \"" + profile + "\" is for boards of the kind " +
                        profile_board + "; spidarctl info usb:" + found.device.path +
                        " lists the profiles that fit",
                    DeviceErrorCode::kSettings);
}

}  // namespace

template <typename BoardType>
std::function<BoardType&()> usb_opener(const std::string& name, const std::string& id,
                                       const Profile& profile,
                                       const std::vector<const DeviceKind*>& kinds,
                                       std::vector<std::unique_ptr<BoardType>>& boards) {
  std::map<const DeviceKind*, std::pair<UsbTransport*, BoardType*>> of_kind;
  for (const DeviceKind* kind : kinds) {
    auto transport = std::make_unique<UsbTransport>(name, kind->usb);
    UsbTransport* const selects = transport.get();
    boards.push_back(
        std::get<std::unique_ptr<BoardType>>(kind->attach(name, profile, std::move(transport))));
    of_kind[kind] = {selects, boards.back().get()};
  }
  return [=, search = UsbSearch(kinds, name, id), profile_name = profile.name,
          profile_board = profile.board]() mutable -> BoardType& {
    BoardType* used = nullptr;
    const auto close = [&used] {
      if (used) used->close();
      used = nullptr;
    };
    try {
      search.open(
          [&](const UsbSearch::Candidate& candidate) {
            require_profile_for(candidate, name, profile_name, profile_board);
            const auto& [transport, board] = of_kind.at(candidate.kind);
            transport->select(candidate.device);
            used = board;
            used->open();
            return used->rotary();
          },
          close);
    } catch (...) {
      close();
      throw;
    }
    return *used;
  };
}

template std::function<boards::Board&()> usb_opener(const std::string&, const std::string&,
                                                    const Profile&,
                                                    const std::vector<const DeviceKind*>&,
                                                    std::vector<std::unique_ptr<boards::Board>>&);
template std::function<boards::ForceBoard&()> usb_opener(
    const std::string&, const std::string&, const Profile&, const std::vector<const DeviceKind*>&,
    std::vector<std::unique_ptr<boards::ForceBoard>>&);

}  // namespace spidar
