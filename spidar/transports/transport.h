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
  static constexpr int64_t kBusyPatience_ns = 300'000'000;
  static constexpr int64_t kBusyCheck_ns = 10'000'000;

  virtual ~Transport() = default;

  /// Claims the connection. Throws DeviceError with a message that says what to do. May be called
  /// again after close() or kGone.
  virtual void open() = 0;

  /// Sends packets in order, then receives one that fills `reply`; if `reply` is empty, only sends.
  /// Blocks until the exchange is complete, or until the deadline (CLOCK_MONOTONIC), and then
  /// returns kTimeout. Returns kShort if fewer bytes arrive than `reply` can hold. Whatever the
  /// result, the packets may have arrived.
  ///
  /// The newest state counts: received data is dropped if it arrived before the packets went out,
  /// because it cannot answer them. When such data does not end, or when the exchanges that found
  /// such data exceed the others by kMostUnasked, the result is kBabble.
  Transfer exchange(std::initializer_list<ByteView> packets, MutableBytes reply,
                    int64_t deadline_ns) noexcept {
    if (packets.size() == 0 || reply.size == 0) return transfer(packets, reply, deadline_ns);
    const int64_t now_ns = monotonic_now_ns();
    const Unasked unasked = drop_unasked(now_ns + (deadline_ns - now_ns) / 2);
    unasked_ = std::clamp(unasked_ + (unasked == Unasked::kNone ? -1 : 1), 0, kMostUnasked);
    Transfer result = transfer(packets, reply, deadline_ns);
    const bool answered = result.fault == LinkFault::kNone || result.fault == LinkFault::kShort;
    if (answered && (unasked == Unasked::kEndless || unasked_ == kMostUnasked)) {
      result.fault = LinkFault::kBabble;
    }
    return result;
  }

  /// Sends a vendor request without data; kRefused if there is no such pipe. Blocks as exchange()
  /// does.
  virtual LinkFault control(const VendorRequest&, int64_t) noexcept { return LinkFault::kRefused; }

  /// Call this after a fault: clears stalls, discards pending replies, may block some ms.
  virtual void recover() noexcept = 0;

  /// Where the open device was found, for the beginning of a description: "at 1-2: "; empty when
  /// the name says so.
  virtual std::string where() const { return {}; }

  /// Returns a will, without packets, with which another process can reach the same board; empty if
  /// that is not possible. Call this after open(). Throws DeviceError without a file.
  virtual std::optional<LastWill> last_will() const = 0;

  /// May be called twice.
  virtual void close() noexcept = 0;

  /// Two seconds of exchanges. A few surplus answers, which are dropped, are no reason to stop.
  static constexpr int kMostUnasked = 2000;

 protected:
  enum class Unasked { kNone, kDropped, kEndless };

  /// The part of exchange() that differs between connections.
  virtual Transfer transfer(std::initializer_list<ByteView> packets, MutableBytes reply,
                            int64_t deadline_ns) noexcept = 0;
  /// Drops data that has arrived and answers nothing, until there is no more (kDropped) or until
  /// `until_ns` (kEndless). A USB board keeps such answers itself, a few of them at most.
  virtual Unasked drop_unasked(int64_t) noexcept { return Unasked::kNone; }

 private:
  int unasked_ = 0;  ///< exchanges before which data was dropped, minus the other exchanges
};

/// Locks an open device file for this file descriptor until it is closed. Waits up to
/// Transport::kBusyPatience_ns, because a program that has just been killed, or its guardian, may
/// hold the lock a moment longer. Returns false and sets errno without the lock; EWOULDBLOCK means
/// that another process holds it.
inline bool lock_device(int file) noexcept {
  const int64_t until_ns = monotonic_now_ns() + Transport::kBusyPatience_ns;
  while (flock(file, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK || monotonic_now_ns() > until_ns) return false;
    sleep_until_ns(monotonic_now_ns() + Transport::kBusyCheck_ns);
  }
  return true;
}

}  // namespace spidar
