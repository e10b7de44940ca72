// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Faults of the link between host and board, by name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace spidar {

enum class LinkFault : uint8_t {
  kNone,
  kTimeout,      ///< no answer in time
  kStall,        ///< the endpoint rejects the packet
  kShort,        ///< fewer bytes than expected
  kBabble,       ///< more bytes than expected
  kBusError,     ///< broken packets on the wire; often the first fault when a board is unplugged
  kGone,         ///< unplugged
  kWrongReply,   ///< of the right length, but not the expected answer
  kWrongEcho,    ///< the board echoes D/A values that were not sent
  kCounterJump,  ///< a counter changed by more than a hand can cause
  kUnguarded,    ///< the guardian has ended, for example because it was killed
  kStoodStill,   ///< this process stood still, so that the guardian set the motors to zero
  kRefused,      ///< the kernel's driver refuses what it is asked for
};
constexpr size_t kLinkFaults = 13;

/// "none", "time-out", "stall", "short packet", …
constexpr const char* to_string(LinkFault fault) noexcept {
  switch (fault) {
    case LinkFault::kNone:
      return "none";
    case LinkFault::kTimeout:
      return "time-out";
    case LinkFault::kStall:
      return "stall";
    case LinkFault::kShort:
      return "short packet";
    case LinkFault::kBabble:
      return "babble";
    case LinkFault::kBusError:
      return "bus error";
    case LinkFault::kGone:
      return "unplugged";
    case LinkFault::kWrongReply:
      return "wrong reply";
    case LinkFault::kWrongEcho:
      return "wrong echo";
    case LinkFault::kCounterJump:
      return "counter jump";
    case LinkFault::kUnguarded:
      return "guardian ended";
    case LinkFault::kStoodStill:
      return "player stood still";
    case LinkFault::kRefused:
      return "refused by the driver";
  }
  return "unknown";
}

/// Statistics of a link since the device was created.
struct LinkHealth {
  std::array<uint64_t, kLinkFaults> faults{};  ///< by LinkFault; kNone: successful exchanges
  LinkFault last_fault = LinkFault::kNone;
  uint64_t late_replies = 0;  ///< came too late for their tick and were used in the next one
  /// Time from passing a packet to the link until its answer; 0 if nothing is measured.
  int64_t round_trip_median_ns = 0;
  int64_t round_trip_p99_ns = 0;
  int64_t round_trip_max_ns = 0;

  /// All faults except time-outs.
  uint64_t errors() const noexcept {
    uint64_t sum = 0;
    for (size_t i = 2; i < kLinkFaults; ++i) sum += faults[i];
    return sum;
  }
  uint64_t count(LinkFault fault) const noexcept { return faults[static_cast<size_t>(fault)]; }
};

}  // namespace spidar
