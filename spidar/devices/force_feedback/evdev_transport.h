// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Force-feedback devices of Linux.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "spidar/devices/force_feedback/evdev_list.h"
#include "spidar/devices/force_feedback/packets.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// Access to a force-feedback device through evdev, for the requests of packets.h. A call takes as
/// long as the driver needs; deadlines have no effect. The kernel stops and erases all effects when
/// the last process that has the file open closes it or ends.
class EvdevTransport final : public Transport {
 public:
  /// `name` is for messages. An empty `path` means the first device of list_force_feedback(). Later
  /// openings look for the device that was opened first, whatever its number is by then. `axes` is
  /// 1 for a wheel, 2 for a joystick, and 0 if is_wheel() decides.
  EvdevTransport(std::string name, std::string path, int axes = 0);
  ~EvdevTransport() override;

  void open() override;
  /// The calls are independent of each other, so there is nothing to recover.
  void recover() noexcept override {}
  std::optional<LastWill> last_will() const override;
  void close() noexcept override;

 private:
  Transfer transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t deadline_ns) noexcept override;
  [[noreturn]] void fail(const std::string& path, const std::string& what,
                         SourceLocation location = SourceLocation::here());
  std::string find();
  void find_axes(const std::string& path, const EvdevTraits& traits);
  void find_buttons(const EvdevTraits& traits);
  LinkFault send(ByteView packet, MutableBytes reply, size_t& received) noexcept;
  ff::Description describe() const noexcept;
  bool read_position(ff::Position& position) const noexcept;
  bool read_buttons(ff::Position& position) const noexcept;

  const std::string name_;
  const std::string path_;
  const int axes_;
  FirstDevice first_;
  int file_ = -1;
  std::array<char, 80> device_name_{};
  bool starts_centred_ = false;
  /// Whether the number of axes follows from the USB ID.
  bool axes_by_id_ = false;
  int right_axis_ = -1;  ///< ABS_…; −1: none
  int up_axis_ = -1;
  std::vector<uint16_t> buttons_;  ///< BTN_…, in the order of their bits
};

}  // namespace spidar
