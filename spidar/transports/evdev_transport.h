// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Force-feedback devices of Linux, by the calls of evdev.
#pragma once

#include <string>

#include "core/api.h"
#include "spidar/protocols/force_feedback.h"
#include "spidar/transports/transport.h"

namespace spidar {

/// Takes the requests of protocols/force_feedback.h. A call lasts as long as the driver takes, and
/// no deadline ends it. The kernel ends and erases all effects when the last process that has the
/// file closes it or dies.
class SPIDAR_API EvdevTransport final : public Transport {
 public:
  /// `name` is for messages. An empty `path` is the first of list_force_feedback() every time it is
  /// opened.
  EvdevTransport(std::string name, std::string path);
  ~EvdevTransport() override;

  void open() override;
  Transfer exchange(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t deadline_ns) noexcept override;
  /// Every call is complete in itself.
  void recover() noexcept override {}
  std::optional<LastWill> last_will() const override;
  void close() noexcept override;

 private:
  [[noreturn]] void fail(const std::string& path, const std::string& what);
  void find_axes() noexcept;
  LinkFault send(ByteView packet, MutableBytes reply, size_t& received) noexcept;
  ff::Description describe() const noexcept;
  bool read_position(ff::Position& position) const noexcept;

  const std::string name_;
  const std::string path_;
  int file_ = -1;
  int right_axis_ = -1;  ///< ABS_…; −1: none
  int up_axis_ = -1;
};

}  // namespace spidar
