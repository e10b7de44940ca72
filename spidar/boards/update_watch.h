// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Whether the updates that another thread makes arrive at a device.
#pragma once

#include <cstdint>

#include "spidar/link_fault.h"
#include "spidar/realtime/seqlock.h"

namespace spidar {

/// Exchanges are faster than updates. A failed update is reported to one exchange only, because the
/// haptic loop gives a device up after 20 faults in a row, which would be a single one of a slow
/// driver. Every exchange gets a fault when nothing shows that the device still follows: kFailures
/// updates have failed in a row, or none has ended for kPatience_ns, because the driver does not
/// return. The device holds its last force meanwhile, so the loop must not take it for a healthy
/// one.
///
/// finish() is called by the thread that makes the updates, everything else by the one that
/// exchanges.
class UpdateWatch {
 public:
  /// Failures in a row before all exchanges fail, as for a board on USB (see BoardDevice): one
  /// fault may concern only one packet.
  static constexpr uint32_t kFailures = 3;
  /// Twice the time that the slowest drivers need, about 50 ms, and as long as other exchanges of a
  /// force-feedback device may last.
  static constexpr int64_t kPatience_ns = 100'000'000;

  /// Before finish() is called for the first time.
  void start(int64_t now_ns) noexcept {
    updates_ = last_ = {LinkFault::kNone, 0, 0, now_ns};
    newest_.store(updates_);
    reported_ = 0;
  }

  void finish(LinkFault fault, int64_t now_ns) noexcept {
    updates_.finished_ns = now_ns;
    ++updates_.in_a_row;
    if (fault == LinkFault::kNone) {
      updates_.in_a_row = 0;
    } else {
      updates_.fault = fault;
      ++updates_.failed;
    }
    newest_.store(updates_);
  }

  /// For one exchange.
  LinkFault report(int64_t now_ns) noexcept {
    newest_.try_load(last_);  // keeps the previous one while a new one is being written
    const bool is_new = last_.failed != reported_;
    reported_ = last_.failed;
    if (now_ns - last_.finished_ns > kPatience_ns) return LinkFault::kTimeout;
    return is_new || last_.in_a_row >= kFailures ? last_.fault : LinkFault::kNone;
  }

 private:
  struct Updates {
    LinkFault fault = LinkFault::kNone;  ///< of the last one that failed
    uint32_t failed = 0;
    uint32_t in_a_row = 0;  ///< failed since the last one that succeeded
    int64_t finished_ns = 0;
  };

  Updates updates_;
  Seqlock<Updates> newest_;
  Updates last_;
  uint32_t reported_ = 0;
};

}  // namespace spidar
