// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Bytes to a board and back, whatever the wire.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>

#include "core/api.h"
#include "spidar/guardian/last_will.h"
#include "spidar/protocols/bytes.h"
#include "spidar/transports/link_fault.h"

namespace spidar {

/// How an exchange ended.
struct Transfer {
  LinkFault fault = LinkFault::kNone;
  size_t received = 0;  ///< bytes
};

/// One connection. One thread at a time.
class SPIDAR_API Transport {
 public:
  /// How long open() waits for a connection that is in use, and how often it tries meanwhile.
  static constexpr int64_t kBusyPatience_ns = 300'000'000;
  static constexpr int64_t kBusyCheck_ns = 10'000'000;

  virtual ~Transport() = default;

  /// Claims the connection. Throws DeviceError, naming what to do. After close() or kGone it may be
  /// called again.
  virtual void open() = 0;

  /// Sends packets in order, then receives one that fills `reply`; without room for a reply it only
  /// sends. Blocks until done or until the deadline (CLOCK_MONOTONIC), then gives up and says
  /// kTimeout. Fewer bytes than there is room for are kShort. What was sent may have arrived
  /// whatever the result.
  virtual Transfer exchange(std::initializer_list<ByteView> packets, MutableBytes reply,
                            int64_t deadline_ns) noexcept = 0;

  /// After a fault: ends stalls, and drops replies that are under way. May block for some
  /// milliseconds.
  virtual void recover() noexcept = 0;

  /// By which another process reaches the same board, without packets; empty when none can. After
  /// open(). Throws DeviceError when there is no file to pass on.
  virtual std::optional<LastWill> last_will() const = 0;

  /// Safe to call twice.
  virtual void close() noexcept = 0;
};

}  // namespace spidar
