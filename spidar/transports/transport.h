// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <sys/file.h>

#include "spidar/device.h"
#include "spidar/guardian/guardian.h"
#include "spidar/realtime/monotonic.h"
#include "spidar/transports/bytes.h"
#include "spidar/transports/ftdi.h"

namespace spidar {

/// Result of an exchange.
struct Transfer {
  LinkFault fault = LinkFault::kNone;
  size_t received = 0;  ///< bytes
  int error = 0;        ///< errno of the kernel's driver; 0: unknown
};

/// One connection to a board, for one thread at a time.
class Transport {
 public:
  /// How long open() waits for a connection that is in use, and the interval between attempts.
  static constexpr int64_t kBusyTimeout_ns = 300'000'000;
  static constexpr int64_t kBusyCheck_ns = 10'000'000;

  virtual ~Transport() = default;

  /// Claims the connection. Throws DeviceError with a message that tells the user what to do. May
  /// be called again after close() or after a transfer has returned kGone.
  virtual void open() = 0;

  /// Sends the packets in order, then receives one as long as `reply`; if `reply` is empty, only
  /// sends. Blocks until the exchange is complete; returns kTimeout at the deadline
  /// (CLOCK_MONOTONIC). Returns kShort if fewer bytes arrive than `reply` can hold. The packets may
  /// have reached the board even if the result is a fault.
  ///
  /// Data that arrived before the packets were sent is stale and is dropped. Returns kBabble when
  /// stale data keeps coming, or when the exchanges that found stale data outnumber the others by
  /// kMaxStaleExchanges.
  Transfer exchange(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t deadline_ns) noexcept {
    if (packets.size() == 0 || reply.size == 0) return transfer(packets, reply, deadline_ns);
    const int64_t now_ns = monotonic_now_ns();
    const StaleData stale = drop_stale_data(now_ns + (deadline_ns - now_ns) / 2);
    stale_exchanges_ =
        std::clamp(stale_exchanges_ + (stale == StaleData::kNone ? -1 : 1), 0, kMaxStaleExchanges);
    Transfer result = transfer(packets, reply, deadline_ns);
    const bool answered = result.fault == LinkFault::kNone || result.fault == LinkFault::kShort;
    if (answered && (stale == StaleData::kEndless || stale_exchanges_ == kMaxStaleExchanges)) {
      result.fault = LinkFault::kBabble;
    }
    return result;
  }

  /// Sends a vendor request without data; returns kRefused if the connection has no control pipe.
  /// Blocks until the deadline, like exchange().
  virtual LinkFault control(const VendorRequest&, int64_t) noexcept { return LinkFault::kRefused; }

  /// Call this after a fault: clears stalls, discards pending replies, may block some ms.
  virtual void recover() noexcept = 0;

  /// Where the open device was found, for the beginning of a description: "at 1-2: "; empty when
  /// the name says so.
  virtual std::string where() const { return {}; }

  /// Returns a LastWill without packets, through which another process can reach the same board;
  /// empty if that is impossible. Call this after open(). Throws DeviceError if no file is open.
  virtual std::optional<LastWill> last_will() const = 0;

  /// May be called twice.
  virtual void close() noexcept = 0;

  /// Two seconds of exchanges at 1 kHz: enough for a service to catch up after a pause, and not too
  /// long to wait for the message. This duration is a choice; no measurement stands behind it. Each
  /// exchange drops all that has arrived, so it does not matter how many replies are stale.
  static constexpr int kMaxStaleExchanges = 2000;

 protected:
  enum class StaleData { kNone, kDropped, kEndless };

  /// The part of exchange() that differs between connections.
  virtual Transfer transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                            int64_t deadline_ns) noexcept = 0;
  /// Drops stale received data until none is left (kDropped) or until `until_ns` (kEndless). The
  /// default drops nothing: a USB board buffers its replies itself, and only a few of them.
  virtual StaleData drop_stale_data(int64_t) noexcept { return StaleData::kNone; }

 private:
  int stale_exchanges_ = 0;  ///< exchanges before which data was dropped, minus the other exchanges
};

/// Locks an open device file for this file descriptor until it is closed. Waits up to
/// Transport::kBusyTimeout_ns, because a program that has just been killed, or its guardian, may
/// hold the lock a moment longer. On failure returns false and sets errno, to EWOULDBLOCK if
/// another process holds the lock.
inline bool lock_device(int file) noexcept {
  const int64_t until_ns = monotonic_now_ns() + Transport::kBusyTimeout_ns;
  while (flock(file, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK || monotonic_now_ns() > until_ns) return false;
    sleep_until_ns(monotonic_now_ns() + Transport::kBusyCheck_ns);
  }
  return true;
}

}  // namespace spidar
