// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "spidar/link/device_kind.h"
#include "spidar/profiles/profile.h"
#include "spidar/transports/device_identity.h"
#include "spidar/transports/usb_transport.h"

namespace spidar {

/// Returns the rotary switch that `id` of usb:ID means; −1 when `id` is not one.
int rotary_of(const std::string& id);

/// Finds a board on USB again at every opening, because the address changes when a device is
/// plugged in again. Later openings find the first device, on any port if it has a serial number.
class UsbSearch {
 public:
  struct Candidate {
    const DeviceKind* kind = nullptr;
    UsbDeviceInfo device;

    DeviceIdentity identity() const;
  };

  /// `id` is a bus path, a serial number, or a rotary switch, 0 … 15. If `id` is empty, there must
  /// be only one device.
  UsbSearch(std::vector<const DeviceKind*> kinds, std::string name, std::string id);

  /// Opens the device that is meant. `open` opens a candidate and returns its rotary switch, −1
  /// without one; `close` closes a candidate that is not meant or did not open. Throws DeviceError,
  /// which lists the devices that were found.
  void open(const std::function<int(const Candidate&)>& open, const std::function<void()>& close);
  /// Throws as open() would, without opening anything.
  void require_one() const;

 private:
  std::vector<Candidate> plugged_in() const;
  bool is_unambiguous(const std::vector<Candidate>& found) const;
  bool must_query(const std::vector<Candidate>& found) const;
  std::vector<Candidate> candidates() const;
  bool is_named(const Candidate& candidate) const;
  Candidate open_matching(const std::vector<Candidate>& found,
                          const std::function<int(const Candidate&)>& open,
                          const std::function<void()>& close) const;
  void open_again(const std::function<int(const Candidate&)>& open) const;

  const std::vector<const DeviceKind*> kinds_;
  const std::string name_;
  const std::string id_;
  FirstDevice first_;
  int first_rotary_ = -1;
};

/// Makes a board of each of `kinds`, all of which have this type, and returns the function with
/// which LinkThread opens one of them, see UsbSearch. Throws DeviceError when the boards cannot
/// drive the profile; so does the function when the profile is for another kind of board than the
/// one that is found.
template <typename BoardType>
std::function<BoardType&()> usb_opener(const std::string& name, const std::string& id,
                                       const Profile& profile,
                                       const std::vector<const DeviceKind*>& kinds,
                                       std::vector<std::unique_ptr<BoardType>>& boards);

}  // namespace spidar
